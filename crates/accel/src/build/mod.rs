//! Builders: each turns references into a binary tree. None of them knows a ray.

pub(crate) mod binary;
pub(crate) mod binned_sah;
mod bins;
mod clip;
pub(crate) mod collapse;
pub(crate) mod costs;
mod lanes;
mod layout;
pub(crate) mod morton;
pub(crate) mod parallel;
mod partition;
mod pieces;
pub(crate) mod presplit;
pub(crate) mod pure_leaves;
pub(crate) mod reference;
pub(crate) mod reinsertion;
mod spatial_bins;
pub(crate) mod spatial_split;
#[cfg(test)]
pub(crate) mod testing;
