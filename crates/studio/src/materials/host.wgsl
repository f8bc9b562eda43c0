// What draws a material, in the frame of Bevy's own.

#import bevy_pbr::mesh_functions as midair_mesh
#import bevy_pbr::view_transformations as midair_space

#ifdef PREPASS_PIPELINE
#import bevy_pbr::prepass_io as midair_io
#import bevy_render::globals as midair_time_of
@group(0) @binding(1) var<uniform> midair_globals: midair_time_of::Globals;

fn midair_time() -> f32 {
    return midair_globals.time * dial.midair_pace;
}
#else
#import bevy_pbr::forward_io as midair_io
#import bevy_pbr::mesh_view_bindings as midair_view
#import bevy_pbr::pbr_fragment as midair_fragment
#import bevy_pbr::pbr_functions as midair_light

fn midair_time() -> f32 {
    return midair_view::globals.time * dial.midair_pace;
}
#endif

struct MidairVertex {
    @builtin(instance_index) instance: u32,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
}

struct MidairMoved {
    position: vec3<f32>,
    normal: vec3<f32>,
}

fn midair_there(position: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return position + shift(Point(position, normal, vec3<f32>(0.0), midair_time()));
}

// Where a vertex is moved, and its normal there: from two points beside it, a millimetre away.
fn midair_moved(in: MidairVertex) -> MidairMoved {
    let other = select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), abs(in.normal.y) > 0.7);
    let side = normalize(cross(other, in.normal));
    let up = cross(in.normal, side);
    let there = midair_there(in.position, in.normal);
    let a = midair_there(in.position + 0.001 * side, in.normal) - there;
    let b = midair_there(in.position + 0.001 * up, in.normal) - there;
    let normal = cross(a, b);
    if dot(normal, normal) > 0.0 {
        return MidairMoved(there, normalize(normal));
    }
    return MidairMoved(there, in.normal);
}

#ifdef PREPASS_PIPELINE

@vertex
fn midair_vertex(in: MidairVertex) -> midair_io::VertexOutput {
    let moved = midair_moved(in);
    let from_own = midair_mesh::get_world_from_local(in.instance);
    var out: midair_io::VertexOutput;
    out.world_position = midair_mesh::mesh_position_local_to_world(from_own, vec4<f32>(moved.position, 1.0));
    out.position = midair_space::position_world_to_clip(out.world_position.xyz);
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    out.unclipped_depth = out.position.z;
    out.position.z = min(out.position.z, 1.0);
#endif
#ifdef NORMAL_PREPASS_OR_DEFERRED_PREPASS
    out.world_normal = midair_mesh::mesh_normal_local_to_world(moved.normal, in.instance);
#endif
#ifdef MOTION_VECTOR_PREPASS
    out.previous_world_position = out.world_position;
#endif
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    out.instance_index = in.instance;
#endif
    return out;
}

#else

struct MidairOutput {
    @builtin(position) position: vec4<f32>,
    @location(0) world_position: vec4<f32>,
    @location(1) world_normal: vec3<f32>,
    // As modelled, so that what is on the surface moves with it.
    @location(2) own_position: vec3<f32>,
    @location(3) own_normal: vec3<f32>,
    @location(4) @interpolate(flat) instance: u32,
}

// Outwards by the width of the line, and a little behind: only around what stands out does it show.
fn midair_outside(clip: vec4<f32>, normal: vec3<f32>) -> vec4<f32> {
    let size = midair_view::view.viewport.zw;
    let towards = (midair_view::view.clip_from_world * vec4<f32>(normal, 0.0)).xy * size;
    if dot(towards, towards) == 0.0 {
        return clip;
    }
    let wide = dial.midair_line * max(1.0, size.y / 1080.0);
    let by = 2.0 * wide * normalize(towards) / size;
    return vec4<f32>(clip.xy + by * clip.w, 0.97 * clip.z, clip.w);
}

@vertex
fn midair_vertex(in: MidairVertex) -> MidairOutput {
    let moved = midair_moved(in);
    let from_own = midair_mesh::get_world_from_local(in.instance);
    var out: MidairOutput;
    out.world_position = midair_mesh::mesh_position_local_to_world(from_own, vec4<f32>(moved.position, 1.0));
    out.position = midair_space::position_world_to_clip(out.world_position.xyz);
    out.world_normal = midair_mesh::mesh_normal_local_to_world(moved.normal, in.instance);
    if dial.midair_line > 0.0 {
        out.position = midair_outside(out.position, out.world_normal);
    }
    out.own_position = in.position;
    out.own_normal = moved.normal;
    out.instance = in.instance;
    return out;
}

@fragment
fn midair_fragment_main(in: MidairOutput, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    var io: midair_io::VertexOutput;
    io.position = in.position;
    io.world_position = in.world_position;
    io.world_normal = in.world_normal;
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    io.instance_index = in.instance;
#endif
    var pbr = midair_fragment::pbr_input_from_standard_material(io, is_front);
    if dial.midair_line > 0.0 {
        return vec4<f32>(pbr.material.base_color.rgb, 1.0);
    }
    let from_own = midair_mesh::get_world_from_local(in.instance);
    let axes = mat3x3<f32>(from_own[0].xyz, from_own[1].xyz, from_own[2].xyz);
    let eye = normalize(transpose(axes) * pbr.V);
    var normal = normalize(in.own_normal);
    if dot(normal, eye) < 0.0 && !is_front {
        normal = -normal;
    }
    var plain: Surface;
    plain.colour = pbr.material.base_color.rgb;
    plain.opacity = 1.0;
    plain.roughness = pbr.material.perceptual_roughness;
    plain.metallic = pbr.material.metallic;
    plain.glow = pbr.material.emissive.rgb;
    plain.bend = vec3<f32>(0.0);
    let made = surface(Point(in.own_position, normal, eye, midair_time()), plain);
    pbr.material.base_color = vec4<f32>(made.colour, pbr.material.base_color.a * clamp(made.opacity, 0.0, 1.0));
    pbr.material.perceptual_roughness = clamp(made.roughness, 0.045, 1.0);
    pbr.material.metallic = clamp(made.metallic, 0.0, 1.0);
    pbr.material.emissive = vec4<f32>(made.glow, pbr.material.emissive.a);
    let bent = midair_mesh::mesh_normal_local_to_world(normal + made.bend, in.instance);
    let straight = midair_mesh::mesh_normal_local_to_world(normal, in.instance);
    pbr.N = normalize(pbr.N + bent - straight);
    return midair_light::main_pass_post_lighting_processing(pbr, midair_light::apply_pbr_lighting(pbr));
}

#endif
