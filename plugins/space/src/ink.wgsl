// What is printed: panels and labels, in the colours they were drawn in; no light falls on them.

#import bevy_pbr::forward_io::VertexOutput

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var page: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var page_sampler: sampler;

fn linear_from_gamma(c: vec3<f32>) -> vec3<f32> {
    let low = c / 12.92;
    let high = pow((c + 0.055) / 1.055, vec3(2.4));
    return select(high, low, c < vec3(0.04045));
}

fn gamma_from_linear(c: vec3<f32>) -> vec3<f32> {
    let low = c * 12.92;
    let high = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
    return select(high, low, c < vec3(0.0031308));
}

// Four samples within the pixel: small letters hold still when the head moves.
fn sampled(uv: vec2<f32>) -> vec4<f32> {
    let dx = dpdx(uv);
    let dy = dpdy(uv);
    let a = 0.125 * dx + 0.375 * dy;
    let b = 0.375 * dx - 0.125 * dy;
    return 0.25 * (textureSample(page, page_sampler, uv + a)
        + textureSample(page, page_sampler, uv - a)
        + textureSample(page, page_sampler, uv + b)
        + textureSample(page, page_sampler, uv - b));
}

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
    let texel = sampled(in.uv);
#ifdef VERTEX_COLORS
    // Letters are blended as on a screen, or thin ones look wrong.
    let gamma = gamma_from_linear(texel.rgb) * in.color.rgb;
    let alpha = texel.a * in.color.a;
    return vec4(linear_from_gamma(gamma), alpha);
#else
    return vec4(texel.rgb, 1.0);
#endif
}
