//! Which light the eye's paths carry.
//!
//! Every path belongs to one effect: to reflection or refraction by its first specular event; without
//! one, to what lights the first surface: the sky (environment), photons that were focused (caustics), a
//! second matt surface (indirect), a lamp by its lobe (highlights) or by the matt layer (direct). What is
//! seen as it shines by itself belongs to direct, the sky to environment.

use super::Effect;

/// A set of effects that carry light, and the sight of what shines by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Carriers(u8);

impl Carriers {
    pub const NONE: Carriers = Carriers(0);
    pub const ALL: Carriers = Carriers(0xff);
    pub const DIRECT: Carriers = Carriers(1);
    pub const REFLECTION: Carriers = Carriers(1 << 1);
    pub const REFRACTION: Carriers = Carriers(1 << 2);
    pub const HIGHLIGHTS: Carriers = Carriers(1 << 3);
    pub const CAUSTICS: Carriers = Carriers(1 << 4);
    pub const INDIRECT: Carriers = Carriers(1 << 5);
    pub const ENVIRONMENT: Carriers = Carriers(1 << 6);
    /// Emission, background and ambient light.
    pub const SEEN: Carriers = Carriers(1 << 7);

    /// The set of one; of none for an effect that carries no light.
    pub fn of(effect: Effect) -> Carriers {
        match effect {
            Effect::Direct => Carriers::DIRECT,
            Effect::Reflection => Carriers::REFLECTION,
            Effect::Refraction => Carriers::REFRACTION,
            Effect::Highlights => Carriers::HIGHLIGHTS,
            Effect::Caustics => Carriers::CAUSTICS,
            Effect::Indirect => Carriers::INDIRECT,
            Effect::Environment => Carriers::ENVIRONMENT,
            _ => Carriers::NONE,
        }
    }

    /// Whether any of `others` is among these.
    #[inline]
    pub fn any(self, others: Carriers) -> bool {
        self.0 & others.0 != 0
    }

    #[must_use]
    pub const fn with(self, others: Carriers) -> Carriers {
        Carriers(self.0 | others.0)
    }

    #[must_use]
    pub fn without(self, others: Carriers) -> Carriers {
        Carriers(self.0 & !others.0)
    }
}

/// What is carried where. Behind a matt surface, all of it: that is indirect light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Carried {
    /// Where the eye's path has met nothing specular.
    pub first: Carriers,
    /// Where it has.
    pub behind: Carriers,
}

impl Carried {
    pub const ALL: Carried = Carried { first: Carriers::ALL, behind: Carriers::ALL };

    /// `only`: the effects whose paths make up the image; `without`: what is missing wherever it would be;
    /// `indirect`: whether there is indirect light at all.
    pub fn new(only: Option<&[Effect]>, without: &[Effect], indirect: bool) -> Carried {
        let set = |effects: &[Effect]| effects.iter().fold(Carriers::NONE, |s, &e| s.with(Carriers::of(e)));
        let none = if indirect { Carriers::NONE } else { Carriers::INDIRECT };
        let missing = set(without).with(none);
        let mut first = only.map_or(Carriers::ALL, set);
        if only.is_some() && first.any(Carriers::DIRECT) {
            first = first.with(Carriers::SEEN);
        }
        let ways = Carriers::REFLECTION.with(Carriers::REFRACTION);
        let behind = if first.any(ways) { Carriers::ALL } else { Carriers::NONE };
        Carried { first: first.without(missing), behind: behind.without(missing) }
    }

    /// Whether any light that is carried may have come by it: indirect light by any, caustics from the sky.
    pub fn anywhere(&self, effect: Effect) -> bool {
        let of = Carriers::of(effect).with(Carriers::INDIRECT);
        let of = if effect == Effect::Environment { of.with(Carriers::CAUSTICS) } else { of };
        self.first.with(self.behind).any(of)
    }
}

impl Default for Carried {
    fn default() -> Self {
        Carried::ALL
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn carriers() -> impl Iterator<Item = Effect> {
        Effect::ALL.into_iter().filter(|effect| effect.carries_light())
    }

    #[test]
    fn each_light_belongs_to_one_effect_and_all_of_them_are_the_whole() {
        let mut whole = Carriers::NONE;
        for effect in carriers() {
            let alone = Carried::new(Some(&[effect]), &[], true).first;
            assert!(!whole.any(alone), "{effect} shares nothing with those before");
            whole = whole.with(alone);
        }
        assert_eq!(whole, Carriers::ALL);
    }

    #[test]
    fn behind_mirrors_and_glass_everything_is_carried_or_nothing() {
        for effect in carriers() {
            let way = matches!(effect, Effect::Reflection | Effect::Refraction);
            let behind = Carried::new(Some(&[effect]), &[], true).behind;
            assert_eq!(behind, if way { Carriers::ALL } else { Carriers::NONE }, "{effect}");
        }
    }

    #[test]
    fn what_is_left_out_is_carried_nowhere() {
        for effect in carriers() {
            let left = Carried::new(None, &[effect], true);
            assert!(!left.first.any(Carriers::of(effect)) && !left.behind.any(Carriers::of(effect)));
            assert_eq!(left.first.with(Carriers::of(effect)), Carriers::ALL);
        }
    }
}
