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
pub(super) use avx2::Avx2;

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use super::{EIGHT, Lanes, Simd, Triangle};

    /// A processor with AVX2: there is none of these on another, which makes all calls below sound.
    #[derive(Clone, Copy)]
    pub(in crate::bake) struct Avx2(());

    impl Avx2 {
        #[inline]
        pub fn found() -> Option<Self> {
            std::arch::is_x86_feature_detected!("avx2").then_some(Self(()))
        }
    }

    /// Every intrinsic here is called on the strength of an [`Avx2`].
    macro_rules! call {
        ($($body:tt)*) => {
            // SAFETY: there is an `Avx2`, so the processor has it; loads and stores are of arrays of
            // the registers' length and ask for no alignment.
            unsafe { $($body)* }
        };
    }

    impl Simd for Avx2 {
        type F = __m256;
        type U = __m256i;

        #[inline(always)]
        fn load(self, from: &Lanes) -> __m256 {
            call!(_mm256_loadu_ps(from.as_ptr()))
        }
        #[inline(always)]
        fn store(self, a: __m256, to: &mut Lanes) {
            call!(_mm256_storeu_ps(to.as_mut_ptr(), a))
        }
        #[inline(always)]
        fn splat(self, a: f32) -> __m256 {
            call!(_mm256_set1_ps(a))
        }
        #[inline(always)]
        fn add(self, a: __m256, b: __m256) -> __m256 {
            call!(_mm256_add_ps(a, b))
        }
        #[inline(always)]
        fn sub(self, a: __m256, b: __m256) -> __m256 {
            call!(_mm256_sub_ps(a, b))
        }
        #[inline(always)]
        fn mul(self, a: __m256, b: __m256) -> __m256 {
            call!(_mm256_mul_ps(a, b))
        }
        #[inline(always)]
        fn min(self, a: __m256, b: __m256) -> __m256 {
            call!(_mm256_min_ps(a, b))
        }
        #[inline(always)]
        fn max(self, a: __m256, b: __m256) -> __m256 {
            call!(_mm256_max_ps(a, b))
        }
        #[inline(always)]
        fn sqrt(self, a: __m256) -> __m256 {
            call!(_mm256_sqrt_ps(a))
        }
        #[inline(always)]
        fn round(self, a: __m256) -> __m256 {
            call!(_mm256_round_ps::<
                { _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC },
            >(a))
        }
        #[inline(always)]
        fn less(self, a: __m256, b: __m256) -> __m256 {
            call!(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b))
        }
        #[inline(always)]
        fn both(self, a: __m256, b: __m256) -> __m256 {
            call!(_mm256_and_ps(a, b))
        }
        #[inline(always)]
        fn choose(self, which: __m256, a: __m256, b: __m256) -> __m256 {
            call!(_mm256_blendv_ps(b, a, which))
        }
        #[inline(always)]
        fn bits(self, which: __m256) -> u32 {
            call!(_mm256_movemask_ps(which)) as u32
        }
        #[inline(always)]
        fn load_ids(self, from: &[u32; EIGHT]) -> __m256i {
            call!(_mm256_loadu_si256(from.as_ptr().cast()))
        }
        #[inline(always)]
        fn store_ids(self, a: __m256i, to: &mut [u32; EIGHT]) {
            call!(_mm256_storeu_si256(to.as_mut_ptr().cast(), a))
        }
        #[inline(always)]
        fn splat_id(self, a: u32) -> __m256i {
            call!(_mm256_set1_epi32(a as i32))
        }
        #[inline(always)]
        fn same(self, a: __m256i, b: __m256i) -> __m256 {
            call!(_mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b)))
        }
        #[inline(always)]
        fn choose_ids(self, which: __m256, a: __m256i, b: __m256i) -> __m256i {
            call!(_mm256_blendv_epi8(b, a, _mm256_castps_si256(which)))
        }
        #[inline(always)]
        fn from<const AT: usize>(self, a: __m256, b: __m256) -> __m256 {
            call!({
                let (a, b) = (_mm256_castps_si256(a), _mm256_castps_si256(b));
                _mm256_castsi256_ps(turned::<AT>(a, b))
            })
        }
        #[inline(always)]
        fn ids_from<const AT: usize>(self, a: __m256i, b: __m256i) -> __m256i {
            call!(turned::<AT>(a, b))
        }
        #[inline(always)]
        fn gather(self, triangles: &[Triangle], ids: &[u32; EIGHT]) -> [__m256; 16] {
            let zero = self.splat(0.0);
            let (mut low, mut high) = ([zero; EIGHT], [zero; EIGHT]);
            for i in 0..EIGHT {
                let t = std::ptr::from_ref(&triangles[ids[i] as usize]).cast::<f32>();
                // SAFETY: a triangle is sixteen numbers on end, and no alignment is asked for.
                unsafe {
                    low[i] = _mm256_loadu_ps(t);
                    high[i] = _mm256_loadu_ps(t.add(EIGHT));
                }
            }
            let [a, b] = [call!(transposed(low)), call!(transposed(high))];
            [
                a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], b[0], b[1], b[2], b[3], b[4], b[5],
                b[6], b[7],
            ]
        }
    }

    /// Eight of sixteen, from `AT` on.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn turned<const AT: usize>(a: __m256i, b: __m256i) -> __m256i {
        let first = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        let at = _mm256_add_epi32(first, _mm256_set1_epi32(AT as i32));
        let beyond = _mm256_cmpgt_epi32(at, _mm256_set1_epi32(EIGHT as i32 - 1));
        let a = _mm256_permutevar8x32_epi32(a, at);
        _mm256_blendv_epi8(a, _mm256_permutevar8x32_epi32(b, at), beyond)
    }

    /// Rows become columns.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn transposed(r: [__m256; 8]) -> [__m256; 8] {
        let pair = |a, b| (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
        let quad = |a: (__m256, __m256), b: (__m256, __m256)| {
            [
                _mm256_shuffle_ps::<0x44>(a.0, b.0),
                _mm256_shuffle_ps::<0xee>(a.0, b.0),
                _mm256_shuffle_ps::<0x44>(a.1, b.1),
                _mm256_shuffle_ps::<0xee>(a.1, b.1),
            ]
        };
        let a = quad(pair(r[0], r[1]), pair(r[2], r[3]));
        let b = quad(pair(r[4], r[5]), pair(r[6], r[7]));
        [
            _mm256_permute2f128_ps::<0x20>(a[0], b[0]),
            _mm256_permute2f128_ps::<0x20>(a[1], b[1]),
            _mm256_permute2f128_ps::<0x20>(a[2], b[2]),
            _mm256_permute2f128_ps::<0x20>(a[3], b[3]),
            _mm256_permute2f128_ps::<0x31>(a[0], b[0]),
            _mm256_permute2f128_ps::<0x31>(a[1], b[1]),
            _mm256_permute2f128_ps::<0x31>(a[2], b[2]),
            _mm256_permute2f128_ps::<0x31>(a[3], b[3]),
        ]
    }
}

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
