//! The images of model files, in the words of the component.

use halfway_mesh::{GltfMaps, MtlMaps, SourceChannel, SourceLevels, SourceMap, SourceMaterial, SourceWrap};
use halfway_texture::{Channel, LevelFilter, MapKind, Sampling, TexelFilter, Texture, UvTransform, Wrap};

/// The images that a material refers to, each with its kind.
pub(crate) fn maps(source: &SourceMaterial) -> Vec<(MapKind, &SourceMap)> {
    let all = match source {
        SourceMaterial::Mtl(mtl) => {
            let MtlMaps { kd, ks, ke, d, ns, norm, bump } = &mtl.maps;
            vec![
                (MapKind::Color, kd),
                (MapKind::Specular, ks),
                (MapKind::Emission, ke),
                (MapKind::Opacity, d),
                (MapKind::Shininess, ns),
                (MapKind::Normal, norm),
                (MapKind::Height, bump),
            ]
        }
        SourceMaterial::MetallicRoughness(gltf) => {
            let GltfMaps { base_color, emissive, occlusion, normal } = &gltf.maps;
            vec![
                (MapKind::Color, base_color),
                (MapKind::Specular, gltf.specular_glossiness.as_ref().map_or(&None, |specular| &specular.map)),
                (MapKind::Emission, emissive),
                (MapKind::Occlusion, occlusion),
                (MapKind::Normal, normal),
            ]
        }
    };
    all.into_iter().filter_map(|(kind, map)| Some((kind, map.as_ref()?))).collect()
}

/// Its sampling.
pub(crate) fn sampling(source: &SourceMap) -> Sampling {
    let filter = |smooth| if smooth { TexelFilter::Bilinear } else { TexelFilter::Nearest };
    Sampling {
        wrap: source.wrap.map(|wrap| match wrap {
            SourceWrap::Repeat => Wrap::Repeat,
            SourceWrap::Mirror => Wrap::Mirror,
            SourceWrap::Clamp => Wrap::Clamp,
        }),
        magnify: filter(source.smooth),
        minify: filter(source.smooth_levels),
        levels: match source.levels {
            SourceLevels::None => LevelFilter::None,
            SourceLevels::Nearest => LevelFilter::Nearest,
            SourceLevels::Linear => LevelFilter::Linear,
        },
    }
}

/// The transform from the coordinates of a mesh to its own.
pub(crate) fn transform(source: &SourceMap) -> UvTransform {
    UvTransform { offset: source.offset, rotation: source.rotation, scale: source.scale }
}

/// The number of a texel that counts.
pub(crate) fn channel(source: &SourceMap, kind: MapKind, texture: &Texture) -> Channel {
    // Programs write the opacity either into a grey image or into the alpha of one with colors.
    let has_alpha = || texture.0.level(0).iter().any(|texel| texel[3] < 1.0);
    match source.channel {
        Some(SourceChannel::Green) => Channel::Green,
        Some(SourceChannel::Blue) => Channel::Blue,
        Some(SourceChannel::Alpha) => Channel::Alpha,
        None if kind == MapKind::Opacity && has_alpha() => Channel::Alpha,
        Some(SourceChannel::Red) | None => Channel::Red,
    }
}
