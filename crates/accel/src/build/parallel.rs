//! Many jobs through an [`Executor`] that joins two.

use crate::Executor;

/// Run `job` on each item, in any order or at once.
pub(crate) fn for_each<T: Send>(items: &mut [T], executor: &dyn Executor, job: &(dyn Fn(&mut T) + Sync)) {
    match items {
        [] => {}
        [one] => job(one),
        more => {
            let (a, b) = more.split_at_mut(more.len() / 2);
            executor.join(&mut || for_each(a, executor, job), &mut || for_each(b, executor, job));
        }
    }
}
