//! Animations: channels, each of which moves a number of a node.

use gltf::Document;
use gltf::animation::Interpolation as GltfInterpolation;
use gltf::json::animation::Property;
use gltf::json::validation::Checked;

use super::accessor::{self, Accessors};
use super::fault::Fault;
use super::nodes::Nodes;
use crate::animation::{Channel, Clip, Curve, Interpolation, Target};

/// Reads the animations, and counts the channels that move nothing.
#[derive(Default)]
pub(super) struct Clips {
    pub(super) clips: Vec<Clip>,
    /// Channels without a node, of unknown paths, or of nodes that are not shown.
    pub(super) unknown: usize,
}

impl Clips {
    pub(super) fn read<'a>(
        document: &'a Document,
        nodes: &Nodes,
        accessors: &mut Accessors<'a>,
    ) -> Result<Self, Fault> {
        let mut all = Self::default();
        for (a, animation) in document.as_json().animations.iter().enumerate() {
            let mut channels = Vec::new();
            for (c, channel) in animation.channels.iter().enumerate() {
                let element = || format!("animations[{a}].channels[{c}]");
                let node = channel.target.node.value();
                if node >= document.nodes().len() {
                    let expected = format!("one of the {} nodes, from 0, is", document.nodes().len());
                    return Err(Fault::element(element() + ".target.node", node.to_string(), expected));
                }
                let target = match channel.target.path {
                    Checked::Valid(Property::Translation) => Target::Translation,
                    Checked::Valid(Property::Rotation) => Target::Rotation,
                    Checked::Valid(Property::Scale) => Target::Scale,
                    Checked::Valid(Property::MorphTargetWeights) => Target::Weights,
                    Checked::Invalid => {
                        all.unknown += 1;
                        continue;
                    }
                };
                // Validation has found the sampler.
                let sampler = &animation.samplers[channel.sampler.value()];
                let interpolation = match sampler.interpolation {
                    Checked::Valid(GltfInterpolation::Step) => Interpolation::Step,
                    Checked::Valid(GltfInterpolation::CubicSpline) => Interpolation::CubicSpline,
                    Checked::Valid(GltfInterpolation::Linear) | Checked::Invalid => Interpolation::Linear,
                };
                let curve = curve(
                    document,
                    (sampler.input.value(), sampler.output.value()),
                    (target, interpolation),
                    accessors,
                )?;
                match nodes.place(node) {
                    Some(node) => channels.push(Channel { node, target, curve }),
                    None => all.unknown += 1,
                }
            }
            if !channels.is_empty() {
                let duration = channels.iter().map(|channel| channel.curve.end()).fold(0.0, f64::max);
                all.clips.push(Clip { name: animation.name.clone().unwrap_or_default(), duration, channels });
            }
        }
        Ok(all)
    }
}

/// The key frames of a sampler, by the accessors of its times and values.
fn curve<'a>(
    document: &'a Document,
    (input, output): (usize, usize),
    (target, interpolation): (Target, Interpolation),
    accessors: &mut Accessors<'a>,
) -> Result<Curve, Fault> {
    let accessor = |index: usize| {
        let expected = || format!("one of the {} accessors, from 0, is", document.accessors().len());
        document.accessors().nth(index).ok_or_else(|| Fault::element("accessors", index.to_string(), expected()))
    };
    let (input, output) = (accessor(input)?, accessor(output)?);
    let times: Vec<f32> = accessors.floats::<1>(&input, &accessor::TIME)?.into_flattened();
    if let Some(at) = times.windows(2).position(|two| two[1] <= two[0]) {
        let found = format!("time {} after {}", times[at + 1], times[at]);
        return Err(Fault::element(accessor::name(&input), found, "times that grow are"));
    }
    let (values, width) = match target {
        Target::Translation | Target::Scale => {
            (accessors.floats::<3>(&output, &accessor::LENGTHS)?.into_flattened(), 3)
        }
        Target::Rotation => (accessors.floats::<4>(&output, &accessor::TURN)?.into_flattened(), 4),
        Target::Weights => (accessors.floats::<1>(&output, &accessor::WEIGHT)?.into_flattened(), 0),
    };
    let each = times.len() * interpolation.values();
    let fits = if width == 0 { values.len().is_multiple_of(each) } else { values.len() == each * width };
    if !fits {
        let found = format!("{} values for {} key frames", output.count(), times.len());
        let expected = match interpolation {
            Interpolation::CubicSpline => "three for each, of each weight, are",
            Interpolation::Step | Interpolation::Linear => "one for each, of each weight, is",
        };
        let expected = if width == 0 { expected.to_owned() } else { expected.replace(", of each weight,", "") };
        return Err(Fault::element(accessor::name(&output), found, expected));
    }
    Ok(Curve::new(times, values, interpolation))
}
