/// Makes a function twice, once for wider registers: the same bits either way. What it calls must be
/// `inline(always)` to be made twice as well.
macro_rules! wide {
    ($vis:vis $name:ident, $wide:ident, $body:ident, ($($arg:ident: $type:ty),* $(,)?) $(-> $out:ty)?) => {
        $vis fn $name($($arg: $type),*) $(-> $out)? {
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has AVX2, as just asked.
                return unsafe { $wide($($arg),*) };
            }
            $body($($arg),*)
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn $wide($($arg: $type),*) $(-> $out)? {
            $body($($arg),*)
        }
    };
}
