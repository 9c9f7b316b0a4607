//! Remembers what was tested last, since a primitive may stand in several cells along a ray (Amanatides & Woo 1987).

/// The last few primitives tested. Forgetting costs a needless test, no more.
pub(crate) struct Mailbox {
    slots: [u32; 8],
    next: usize,
}

impl Mailbox {
    pub fn new() -> Self {
        Mailbox { slots: [u32::MAX; 8], next: 0 }
    }

    /// Notes the primitive; false when it is known to have been tested.
    #[inline(always)]
    pub fn is_new(&mut self, primitive: u32) -> bool {
        if self.slots.contains(&primitive) {
            return false;
        }
        self.slots[self.next & 7] = primitive;
        self.next += 1;
        true
    }
}
