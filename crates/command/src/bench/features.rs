//! `halfway bench features`: the cost of each feature of lighting, once a vertex and once a pixel.

use halfway::prelude::*;
use halfway::render::Adapter;
use halfway_chart::timing::{FRAME_TIME, Machine, Spread, median, median_ratio};
use serde_json::json;

use super::app::finish;
use super::args::BenchArgs;
use super::cpu::{self, CpuTimes};
use super::facts::{counters, print_facts, spread};
use crate::failure::Failure;
use crate::scenery::features::{Feature, FeatureScene, FeatureStage};

/// The cost of one stage under one feature.
struct Cost {
    frame: Spread,
    /// Relative to the baseline.
    ratio: f64,
    /// The cost of a light at a vertex or pixel, where it is defined.
    per_light_ns: Option<f64>,
    cpu: CpuTimes,
    report: FrameReport,
}

pub(super) fn run(args: &BenchArgs) -> Result<(), Failure> {
    args.expect_no_scene("features")?;
    let features = Feature::all();
    // One adapter for all Apps, so that two dozen of them need not share the machine.
    let adapter = args.adapter.choice().open()?;
    let stages = [FeatureStage::vertex(), FeatureStage::fragment()];
    let [vertex, fragment] = stages.each_ref().map(|stage| measure(&features, stage, &adapter, args.rounds));
    let (vertex, fragment) = (vertex?, fragment?);
    let machine = Machine::new(&adapter);
    let rows: Vec<_> = features.iter().zip(vertex.iter().zip(&fragment)).collect();
    if args.json {
        print_json(args, &machine, &stages, &rows);
    } else {
        print_table(args, &machine, &stages, &rows);
    }
    Ok(())
}

/// Every feature at one stage, all in turns.
fn measure(features: &[Feature], stage: &FeatureStage, adapter: &Adapter, rounds: u32) -> Result<Vec<Cost>, Failure> {
    let mut apps: Vec<App> = features.iter().map(|feature| app(*feature, stage, adapter)).collect();
    let timed = cpu::timed(&mut apps, rounds)?;
    let (times, cpu): (Vec<_>, Vec<_>) = timed.into_iter().unzip();
    let baseline = features.iter().position(|feature| *feature == Feature::BASELINE).unwrap_or(0);
    let unlit = features.iter().position(|feature| feature.lights.count() == 0);
    let costs = features.iter().zip(&apps).zip(times.iter().zip(cpu)).map(|((feature, app), (own, cpu))| {
        let evaluations = f64::from(feature.lights.count()) * f64::from(stage.evaluations);
        let unlit = unlit.filter(|_| feature.is_about_lights());
        // Differences within a round, as for ratios.
        let more = unlit.map(|unlit| own.iter().zip(&times[unlit]).map(|(a, b)| a - b).collect::<Vec<_>>());
        Cost {
            frame: Spread::from_values(own),
            ratio: median_ratio(own, &times[baseline]),
            per_light_ns: more.map(|more| median(&more) * 1e6 / evaluations),
            cpu,
            report: app.world().resource::<FrameReport>().clone(),
        }
    });
    Ok(costs.collect())
}

fn app(feature: Feature, stage: &FeatureStage, adapter: &Adapter) -> App {
    let mut app = App::new();
    adapter.clone().insert_into(app.world_mut());
    app.add_plugins((HalfwayPlugins::headless(stage.size), FeatureScene { feature, stage: stage.clone() }));
    finish(&mut app);
    app
}

type Row<'a> = (&'a Feature, (&'a Cost, &'a Cost));

fn print_table(args: &BenchArgs, machine: &Machine, stages: &[FeatureStage; 2], rows: &[Row<'_>]) {
    println!("the cost of features, {} rounds", args.rounds);
    print_facts(machine);
    println!("\n{FRAME_TIME}\nMedians; × is to the baseline, the median of the ratios within a round.");
    if let Some((_, (vertex, fragment))) = rows.first() {
        let named = [("vertex: Gouraud", vertex), ("pixel: Phong", fragment)];
        for ((what, cost), stage) in named.into_iter().zip(stages) {
            let UVec2 { x, y } = stage.size;
            let (triangles, count) = (cost.report.triangles, stage.evaluations);
            println!(
                "Once a {what} shading, {triangles} triangles on {x} × {y} pixels, each light {count} times a frame."
            );
        }
    }
    println!("A light's cost is what the frame takes longer than with no lights, by lights and vertices or pixels.\n");
    println!("| | vertex, ms | × | a light, ns | pixel, ms | × | a light, ns |");
    println!("|---|---|---|---|---|---|---|");
    for (feature, (vertex, fragment)) in rows {
        let cells = [vertex, fragment].map(|Cost { frame, ratio, per_light_ns, .. }| {
            let light = per_light_ns.map_or_else(|| "–".to_owned(), |ns| format!("{ns:.1}"));
            format!("{:.2} | {ratio:.2} | {light}", frame.median)
        });
        println!("| {} | {} | {} |", feature.name, cells[0], cells[1]);
    }
}

fn print_json(args: &BenchArgs, machine: &Machine, stages: &[FeatureStage; 2], rows: &[Row<'_>]) {
    let cost = |it: &Cost| {
        json!({
            "frame_ms": it.frame.median,
            "frame_ms_spread": spread(&it.frame),
            "ratio_to_baseline": it.ratio,
            "light_ns": it.per_light_ns,
            "cpu_ms": it.cpu.json(),
            "report": counters(&it.report),
        })
    };
    let rows: Vec<_> = rows
        .iter()
        .map(|(feature, (vertex, fragment))| {
            json!({
                "feature": feature.name,
                "lights": feature.lights.count(),
                "vertex": cost(vertex),
                "fragment": cost(fragment),
            })
        })
        .collect();
    let [vertex, fragment] = stages
        .each_ref()
        .map(|FeatureStage { size, evaluations, .. }| json!({ "size": size.to_array(), "evaluations": evaluations }));
    println!(
        "{}",
        json!({
            "rounds": args.rounds,
            "machine": machine,
            "frame": FRAME_TIME,
            "stages": { "vertex": vertex, "fragment": fragment },
            "rows": rows,
        })
    );
}
