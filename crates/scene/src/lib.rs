//! kirkas-scene
