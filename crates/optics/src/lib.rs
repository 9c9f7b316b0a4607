//! kirkas-optics
