//! Eight numbers at once: registers of AVX2 where the processor has them, else arrays; the same bits
//! either way.

use std::ops::{Add, BitAnd, Mul, Sub};

use super::triangle::Triangle;

pub(super) const EIGHT: usize = 8;
pub(super) type Lanes = [f32; EIGHT];

/// What eight numbers are kept in and worked on by. Code over it is `inline(always)`, without closures,
/// and made once for each by [`lanes!`].
pub(super) trait Simd: Copy {
    type F: Copy;
    type U: Copy;

    fn load(self, from: &Lanes) -> Self::F;
    fn store(self, a: Self::F, to: &mut Lanes);
    fn splat(self, a: f32) -> Self::F;
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    /// The second where either is no number.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    fn sqrt(self, a: Self::F) -> Self::F;
    /// To the nearest whole number, the even one of two.
    fn round(self, a: Self::F) -> Self::F;
    /// All bits of a lane, or none.
    fn less(self, a: Self::F, b: Self::F) -> Self::F;
    fn both(self, a: Self::F, b: Self::F) -> Self::F;
    fn choose(self, which: Self::F, a: Self::F, b: Self::F) -> Self::F;
    /// A bit for each lane.
    fn bits(self, which: Self::F) -> u32;
    fn load_ids(self, from: &[u32; EIGHT]) -> Self::U;
    fn store_ids(self, a: Self::U, to: &mut [u32; EIGHT]);
    fn splat_id(self, a: u32) -> Self::U;
    fn same(self, a: Self::U, b: Self::U) -> Self::F;
    fn choose_ids(self, which: Self::F, a: Self::U, b: Self::U) -> Self::U;
    /// Eight of the sixteen that `a` and `b` are end to end, from the one named on.
    fn from<const AT: usize>(self, a: Self::F, b: Self::F) -> Self::F;
    fn ids_from<const AT: usize>(self, a: Self::U, b: Self::U) -> Self::U;
    /// The sixteen numbers of eight triangles, number by number.
    fn gather(self, triangles: &[Triangle], ids: &[u32; EIGHT]) -> [Self::F; 16];
}

/// The whole part of a coordinate in a grid, towards 0.
#[inline(always)]
pub(super) fn whole(a: f32) -> i32 {
    // SAFETY: all places lie in a frame, which has at most 2²⁷ nodes along a side, or a few steps
    // beyond. The checked conversion costs as much as all around it.
    unsafe { a.to_int_unchecked() }
}

/// The first node that is not before `a`.
#[inline(always)]
pub(super) fn after(a: f32) -> i32 {
    let i = whole(a);
    i + i32::from((i as f32) < a)
}

/// The last node that is not behind `a`.
#[inline(always)]
pub(super) fn before(a: f32) -> i32 {
    let i = whole(a);
    i - i32::from(i as f32 > a)
}

/// Eight numbers.
#[derive(Clone, Copy)]
pub(super) struct F8<S: Simd>(pub S, pub S::F);

/// Eight of yes or no.
#[derive(Clone, Copy)]
pub(super) struct M8<S: Simd>(S, S::F);

/// Eight names.
#[derive(Clone, Copy)]
pub(super) struct U8<S: Simd>(S, S::U);

macro_rules! operator {
    ($trait:ident, $name:ident) => {
        impl<S: Simd> $trait for F8<S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, b: Self) -> Self {
                Self(self.0, self.0.$name(self.1, b.1))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);

impl<S: Simd> BitAnd for M8<S> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        Self(self.0, self.0.both(self.1, b.1))
    }
}

#[inline(always)]
fn part<T>(all: &[T], at: usize) -> &[T; EIGHT] {
    match all[at..].first_chunk() {
        Some(part) => part,
        None => &all[at..][..EIGHT].as_chunks().0[0],
    }
}

impl<S: Simd> F8<S> {
    #[inline(always)]
    pub fn splat(s: S, a: f32) -> Self {
        Self(s, s.splat(a))
    }

    /// Those from `at` on.
    #[inline(always)]
    pub fn load(s: S, all: &[f32], at: usize) -> Self {
        Self(s, s.load(part(all, at)))
    }

    #[inline(always)]
    pub fn store(self, all: &mut [f32], at: usize) {
        if let Some(to) = all[at..].first_chunk_mut() {
            self.0.store(self.1, to);
        }
    }

    /// `first`, `first` + 1 and so on.
    #[inline(always)]
    pub fn from(s: S, first: f32) -> Self {
        const ALL: Lanes = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        Self(s, s.load(&ALL)) + Self::splat(s, first)
    }

    #[inline(always)]
    pub fn min(self, b: Self) -> Self {
        Self(self.0, self.0.min(self.1, b.1))
    }

    #[inline(always)]
    pub fn max(self, b: Self) -> Self {
        Self(self.0, self.0.max(self.1, b.1))
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(self.0, self.0.sqrt(self.1))
    }

    #[inline(always)]
    pub fn round(self) -> Self {
        Self(self.0, self.0.round(self.1))
    }

    #[inline(always)]
    pub fn less(self, b: Self) -> M8<S> {
        M8(self.0, self.0.less(self.1, b.1))
    }

    /// Eight of the sixteen that the two are end to end.
    #[inline(always)]
    pub fn end_to_end<const AT: usize>(self, then: Self) -> Self {
        Self(self.0, self.0.from::<AT>(self.1, then.1))
    }

    #[inline(always)]
    pub fn lanes(self) -> Lanes {
        let mut all = [0.0; EIGHT];
        self.0.store(self.1, &mut all);
        all
    }
}

impl<S: Simd> M8<S> {
    #[inline(always)]
    pub fn choose(self, a: F8<S>, b: F8<S>) -> F8<S> {
        F8(self.0, self.0.choose(self.1, a.1, b.1))
    }

    #[inline(always)]
    pub fn choose_ids(self, a: U8<S>, b: U8<S>) -> U8<S> {
        U8(self.0, self.0.choose_ids(self.1, a.1, b.1))
    }

    #[inline(always)]
    pub fn bits(self) -> u32 {
        self.0.bits(self.1)
    }
}

impl<S: Simd> U8<S> {
    #[inline(always)]
    pub fn splat(s: S, a: u32) -> Self {
        Self(s, s.splat_id(a))
    }

    #[inline(always)]
    pub fn load(s: S, all: &[u32], at: usize) -> Self {
        Self(s, s.load_ids(part(all, at)))
    }

    #[inline(always)]
    pub fn store(self, all: &mut [u32], at: usize) {
        if let Some(to) = all[at..].first_chunk_mut() {
            self.0.store_ids(self.1, to);
        }
    }

    #[inline(always)]
    pub fn same(self, b: Self) -> M8<S> {
        M8(self.0, self.0.same(self.1, b.1))
    }

    /// Eight of the sixteen that the two are end to end.
    #[inline(always)]
    pub fn end_to_end<const AT: usize>(self, then: Self) -> Self {
        Self(self.0, self.0.ids_from::<AT>(self.1, then.1))
    }

    #[inline(always)]
    pub fn ids(self) -> [u32; EIGHT] {
        let mut all = [0; EIGHT];
        self.0.store_ids(self.1, &mut all);
        all
    }
}

/// Arrays.
#[derive(Clone, Copy)]
pub(super) struct Plain;

#[inline(always)]
fn each<T: Copy, R>(a: [T; EIGHT], b: [T; EIGHT], f: impl Fn(T, T) -> R) -> [R; EIGHT] {
    std::array::from_fn(|i| f(a[i], b[i]))
}

const YES: f32 = f32::from_bits(u32::MAX);

impl Simd for Plain {
    type F = Lanes;
    type U = [u32; EIGHT];

    #[inline(always)]
    fn load(self, from: &Lanes) -> Lanes {
        *from
    }
    #[inline(always)]
    fn store(self, a: Lanes, to: &mut Lanes) {
        *to = a;
    }
    #[inline(always)]
    fn splat(self, a: f32) -> Lanes {
        [a; EIGHT]
    }
    #[inline(always)]
    fn add(self, a: Lanes, b: Lanes) -> Lanes {
        each(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, a: Lanes, b: Lanes) -> Lanes {
        each(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, a: Lanes, b: Lanes) -> Lanes {
        each(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn min(self, a: Lanes, b: Lanes) -> Lanes {
        each(a, b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, a: Lanes, b: Lanes) -> Lanes {
        each(a, b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn sqrt(self, a: Lanes) -> Lanes {
        a.map(f32::sqrt)
    }
    #[inline(always)]
    fn round(self, a: Lanes) -> Lanes {
        a.map(f32::round_ties_even)
    }
    #[inline(always)]
    fn less(self, a: Lanes, b: Lanes) -> Lanes {
        each(a, b, |a, b| if a < b { YES } else { 0.0 })
    }
    #[inline(always)]
    fn both(self, a: Lanes, b: Lanes) -> Lanes {
        each(a, b, |a, b| f32::from_bits(a.to_bits() & b.to_bits()))
    }
    #[inline(always)]
    fn choose(self, which: Lanes, a: Lanes, b: Lanes) -> Lanes {
        std::array::from_fn(|i| if which[i].to_bits() != 0 { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn bits(self, which: Lanes) -> u32 {
        (0..EIGHT).fold(0, |all, i| all | u32::from(which[i].to_bits() != 0) << i)
    }
    #[inline(always)]
    fn load_ids(self, from: &[u32; EIGHT]) -> [u32; EIGHT] {
        *from
    }
    #[inline(always)]
    fn store_ids(self, a: [u32; EIGHT], to: &mut [u32; EIGHT]) {
        *to = a;
    }
    #[inline(always)]
    fn splat_id(self, a: u32) -> [u32; EIGHT] {
        [a; EIGHT]
    }
    #[inline(always)]
    fn same(self, a: [u32; EIGHT], b: [u32; EIGHT]) -> Lanes {
        each(a, b, |a, b| if a == b { YES } else { 0.0 })
    }
    #[inline(always)]
    fn choose_ids(self, which: Lanes, a: [u32; EIGHT], b: [u32; EIGHT]) -> [u32; EIGHT] {
        std::array::from_fn(|i| if which[i].to_bits() != 0 { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn from<const AT: usize>(self, a: Lanes, b: Lanes) -> Lanes {
        std::array::from_fn(|i| {
            if AT + i < EIGHT {
                a[AT + i]
            } else {
                b[AT + i - EIGHT]
            }
        })
    }
    #[inline(always)]
    fn ids_from<const AT: usize>(self, a: [u32; EIGHT], b: [u32; EIGHT]) -> [u32; EIGHT] {
        std::array::from_fn(|i| {
            if AT + i < EIGHT {
                a[AT + i]
            } else {
                b[AT + i - EIGHT]
            }
        })
    }
    #[inline(always)]
    fn gather(self, triangles: &[Triangle], ids: &[u32; EIGHT]) -> [Lanes; 16] {
        let mut all = [[0.0; EIGHT]; 16];
        for (i, &id) in ids.iter().enumerate() {
            let t = &triangles[id as usize];
            for k in 0..3 {
                for axis in 0..3 {
                    all[3 * k + axis][i] = t.v[k][axis];
                }
                all[9 + k][i] = t.n[k];
                all[12 + k][i] = t.inverse[k];
            }
            all[15][i] = t.limit;
        }
        all
    }
}

#[cfg(target_arch = "x86_64")]
pub(super) use super::avx2::Avx2;

/// A function that calls `$body`, made once for each kind of registers, with the better ones.
macro_rules! lanes {
    ($vis:vis $name:ident, $wide:ident, $body:ident, ($($arg:ident: $type:ty),* $(,)?) $(-> $out:ty)?) => {
        $vis fn $name($($arg: $type),*) $(-> $out)? {
            #[cfg(target_arch = "x86_64")]
            if let Some(s) = $crate::bake::lanes::Avx2::found() {
                // SAFETY: the processor has AVX2, as just asked.
                return unsafe { $wide(s, $($arg),*) };
            }
            $body($crate::bake::lanes::Plain, $($arg),*)
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn $wide(s: $crate::bake::lanes::Avx2, $($arg: $type),*) $(-> $out)? {
            $body(s, $($arg),*)
        }
    };
}
pub(super) use lanes;

#[cfg(test)]
mod tests {
    use super::*;

    lanes!(all, all_avx2, all_any, (a: &Lanes, b: &Lanes, u: &[u32; 8], v: &[u32; 8]) -> Vec<u32>);

    /// The bits that each operation gives.
    #[inline(always)]
    fn all_any<S: Simd>(s: S, a: &Lanes, b: &Lanes, u: &[u32; 8], v: &[u32; 8]) -> Vec<u32> {
        let (x, y) = (F8::load(s, a, 0), F8::load(s, b, 0));
        let (p, q) = (U8::load(s, u, 0), U8::load(s, v, 0));
        let less = x.less(y);
        let mut out = vec![less.bits(), p.same(q).bits(), (less & p.same(q)).bits()];
        for f in [
            x + y,
            x - y,
            x * y,
            x.min(y),
            x.max(y),
            (x * x).sqrt(),
            y.round(),
            less.choose(x, y),
            x.end_to_end::<3>(y),
            x.end_to_end::<8>(y),
            F8::from(s, 5.0),
        ] {
            out.extend(f.lanes().map(f32::to_bits));
        }
        for ids in [less.choose_ids(p, q), p.end_to_end::<7>(q), U8::splat(s, 9)] {
            out.extend(ids.ids());
        }
        out
    }

    #[test]
    fn wide_registers_change_nothing() {
        let odd = [f32::NAN, f32::INFINITY, -0.0, 0.0, 2.5, -3.5, 1e30, 0.49];
        let even = [1.0, -2.0, 0.0, -0.0, 2.5, f32::NAN, 1.5, -1e-30];
        let (u, v) = (
            [1, 2, 3, 4, 5, 6, 7, u32::MAX],
            [1, 0, 3, 9, 5, 8, 7, u32::MAX],
        );
        let wide = all(&odd, &even, &u, &v);
        assert_eq!(wide, all_any(Plain, &odd, &even, &u, &v));
        let less = (0..8).filter(|i| odd[*i] < even[*i]);
        assert_eq!(wide[0], less.fold(0, |bits, i| bits | 1 << i));
    }
}
