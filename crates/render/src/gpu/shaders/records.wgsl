// Records that draws read, and the switches of a pipeline. Needs lighting.wgsl and the lights by their kind.

// The lights are those that the record's lists name. Else they are the first ones bound, so many.
override LISTED: bool = false;
override LIGHTS: u32 = 0;

struct View {
    scale: vec2f,        // x and y of clip space are these times those of eye space, plus center * w
    depth: vec2f,        // z of clip space at the depth d = -z is depth.x * d + depth.y
    w: vec2f,            // and w is w.x * d + w.y: d in a perspective, 1 where rays are parallel
    center: vec2f,       // where the axis of the view meets the picture
}

// Materials and lights. Of the lights, the first of their numbers in `lists`, and the count.
struct Surface {
    front: Material,
    back: Material,
    both: vec2u,
    diffuse: vec2u,               // these lights' specular terms are left out
    specular: vec2u,              // and of these all others
    padding: array<vec4u, 4>,     // up to the 256 bytes that offsets may be multiples of; GLSL would not keep a @size
}

@group(0) @binding(0) var<uniform> view: View;

fn plus(a: Irradiance, b: Irradiance) -> Irradiance {
    return Irradiance(a.ambient + b.ambient, a.diffuse + b.diffuse, a.specular + b.specular);
}
