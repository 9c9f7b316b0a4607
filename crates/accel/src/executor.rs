//! How the caller lends threads to a build.

/// Runs two jobs, perhaps at once. Returns when both are done. The tree built does not depend on it.
pub trait Executor: Sync {
    /// Run both, in any order or at once.
    fn join(&self, a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send));
}

/// One after the other, on the caller's thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct Serial;

impl Executor for Serial {
    fn join(&self, a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
        a();
        b();
    }
}
