//! kirkas-render
