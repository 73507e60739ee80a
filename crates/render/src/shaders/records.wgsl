// What draws read, and what a pipeline knows of them. Needs lighting.wgsl.

// The lights are those that the record's lists name. Else they are the first ones bound, as many of each kind as these
// numbers say.
override LISTED: bool = false;
override DIRECTIONAL: u32 = 0;
override POINTS: u32 = 0;
override SPOTS: u32 = 0;

struct View {
    scale: vec2f,        // x and y of clip space by those of eye space
    depth: vec2f,        // z of clip space at the depth d = -z is depth.x * d + depth.y
    w: vec2f,            // and w is w.x * d + w.y: d in a perspective, 1 where rays are parallel
    padding: vec2f,
}

// Materials and lights. Of these how many directional, point and spot lights, and where their numbers begin among
// `lists`.
struct Surface {
    front: Material,
    back: Material,
    both: vec4u,
    diffuse: vec4u,               // these lights' specular terms are left out
    specular: vec4u,              // and of these all others
    padding: array<vec4u, 3>,     // up to the 256 bytes that offsets may be multiples of; GLSL would not keep a @size
}

@group(0) @binding(0) var<uniform> view: View;

fn plus(a: Irradiance, b: Irradiance) -> Irradiance {
    return Irradiance(a.ambient + b.ambient, a.diffuse + b.diffuse, a.specular + b.specular);
}
