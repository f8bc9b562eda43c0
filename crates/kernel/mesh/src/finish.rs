/// How a surface looks, in the terms of glTF's metallic-roughness model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish {
    /// Base colour in sRGB: red, green, blue.
    pub colour: [u8; 3],
    /// 1 hides what is behind it, 0 hides nothing.
    pub opacity: f32,
    /// 0 as a mirror, 1 as chalk.
    pub roughness: f32,
    /// 0 or 1.
    pub metallic: f32,
}

impl Finish {
    /// The base colour with its opacity in linear light, as glTF holds it.
    pub(crate) fn linear(&self) -> [f32; 4] {
        // The transfer function of IEC 61966-2-1.
        let linear = |byte: u8| {
            let c = f32::from(byte) / 255.0;
            if c <= 0.040_45 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        let [r, g, b] = self.colour.map(linear);
        [r, g, b, self.opacity]
    }
}
