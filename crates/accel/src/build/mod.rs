//! Builders: each turns references into a binary tree. None of them knows a ray.

pub(crate) mod binary;
pub(crate) mod binned_sah;
pub(crate) mod collapse;
#[allow(dead_code)]
pub(crate) mod morton;
#[allow(dead_code)]
mod parallel;
pub(crate) mod reference;
#[cfg(test)]
pub(crate) mod testing;
