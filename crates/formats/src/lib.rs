//! kirkas-formats
