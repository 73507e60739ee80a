// One record and few lights, at fixed places: a software adapter reads them once for eight pixels.

@group(0) @binding(1) var<uniform> draws: array<Draw, 1>;
@group(0) @binding(2) var<uniform> lights: array<Light, MOST_LIGHTS>;

fn light_numbered(i: u32) -> Light {
    return lights[i];
}
