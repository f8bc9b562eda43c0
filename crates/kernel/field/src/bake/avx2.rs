//! Eight numbers at once in registers of AVX2.

use std::arch::x86_64::*;

use super::lanes::{EIGHT, Lanes, Simd};
use super::triangle::Triangle;

/// A processor with AVX2: there is none of these on another, which makes all calls below sound.
#[derive(Clone, Copy)]
pub(super) struct Avx2(());

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
