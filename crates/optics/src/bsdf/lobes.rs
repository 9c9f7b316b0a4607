//! The kinds of lobes a BSDF is made of, and sets of them.

/// One kind of lobe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
#[allow(missing_docs)]
pub enum Lobe {
    DiffuseReflection = 1,
    GlossyReflection = 2,
    DeltaReflection = 4,
    DiffuseTransmission = 8,
    GlossyTransmission = 16,
    DeltaTransmission = 32,
}

impl Lobe {
    /// All kinds.
    pub const ALL: [Lobe; 6] = [
        Lobe::DiffuseReflection,
        Lobe::GlossyReflection,
        Lobe::DeltaReflection,
        Lobe::DiffuseTransmission,
        Lobe::GlossyTransmission,
        Lobe::DeltaTransmission,
    ];

    /// True for a single direction.
    pub fn is_delta(self) -> bool {
        LobeSet::DELTA.contains(self)
    }

    /// True when light goes through.
    pub fn is_transmission(self) -> bool {
        LobeSet::TRANSMISSION.contains(self)
    }

    /// A short name, for records and statistics.
    pub fn name(self) -> &'static str {
        match self {
            Lobe::DiffuseReflection => "diffuse_reflection",
            Lobe::GlossyReflection => "glossy_reflection",
            Lobe::DeltaReflection => "delta_reflection",
            Lobe::DiffuseTransmission => "diffuse_transmission",
            Lobe::GlossyTransmission => "glossy_transmission",
            Lobe::DeltaTransmission => "delta_transmission",
        }
    }
}

/// A set of lobes; `&` and `|` as for sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LobeSet(u8);

impl LobeSet {
    /// None.
    pub const NONE: Self = LobeSet(0);
    /// Every lobe.
    pub const ALL: Self = LobeSet(0b11_1111);
    /// Both diffuse lobes.
    pub const DIFFUSE: Self = LobeSet(0b00_1001);
    /// Both glossy lobes.
    pub const GLOSSY: Self = LobeSet(0b01_0010);
    /// Both delta lobes.
    pub const DELTA: Self = LobeSet(0b10_0100);
    /// All but the delta lobes: what lights that are sampled can see.
    pub const NON_DELTA: Self = LobeSet(0b01_1011);
    /// The three that reflect.
    pub const REFLECTION: Self = LobeSet(0b00_0111);
    /// The three that transmit.
    pub const TRANSMISSION: Self = LobeSet(0b11_1000);

    /// Just this one.
    pub const fn of(lobe: Lobe) -> Self {
        LobeSet(lobe as u8)
    }

    /// True when `lobe` is in it.
    pub const fn contains(self, lobe: Lobe) -> bool {
        self.0 & lobe as u8 != 0
    }

    /// True when the two share a lobe.
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// True when there is none.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// True when there is no more than one.
    pub const fn is_single(self) -> bool {
        self.0 & self.0.wrapping_sub(1) == 0
    }

    /// `self` if `condition`, else none.
    pub const fn when(self, condition: bool) -> Self {
        if condition { self } else { Self::NONE }
    }

    /// Those of `self` that are not in `other`.
    pub const fn without(self, other: Self) -> Self {
        LobeSet(self.0 & !other.0)
    }

    /// Its lobes, reflection first.
    pub fn iter(self) -> impl Iterator<Item = Lobe> {
        Lobe::ALL.into_iter().filter(move |&l| self.contains(l))
    }
}

impl core::ops::BitOr for LobeSet {
    type Output = Self;
    fn bitor(self, o: Self) -> Self {
        LobeSet(self.0 | o.0)
    }
}
impl core::ops::BitAnd for LobeSet {
    type Output = Self;
    fn bitand(self, o: Self) -> Self {
        LobeSet(self.0 & o.0)
    }
}
impl From<Lobe> for LobeSet {
    fn from(lobe: Lobe) -> Self {
        LobeSet::of(lobe)
    }
}
