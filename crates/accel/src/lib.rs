//! kirkas-accel
