// Any number of records and lights. Not uniform: lavapipe compiles a shader anew for every value that a loop's end or a
// condition takes from a uniform buffer.

@group(0) @binding(1) var<storage, read> draws: array<Draw>;
// All lights of the scene by kind: directional, point, spot.
@group(0) @binding(2) var<storage, read> lights: array<Light>;
@group(0) @binding(3) var<storage, read> lists: array<u32>;

fn light_numbered(i: u32) -> Light {
    if LISTED {
        return lights[lists[i]];
    }
    return lights[i];
}
