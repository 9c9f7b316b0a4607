//! kirkas-testkit
