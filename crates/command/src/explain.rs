//! `halfway explain`.

use clap::Args;
use halfway::prelude::*;
use halfway::reference::Oracle;
use halfway::scene::SceneTime;
use halfway::scene::options::remove_what_is_laid_over;

use crate::drawing::{DrawingArgs, SizeArgs};
use crate::failure::Failure;
use crate::input::SceneInput;
use crate::render::parse_time;

#[derive(Args, Debug)]
pub(crate) struct ExplainArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    #[command(flatten)]
    size: SizeArgs,
    /// The column and the row of the pixel, from the top left, counted from 0
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    at: [u32; 2],
    /// Explain the scene's animation at T seconds
    #[arg(long, value_name = "T", value_parser = parse_time)]
    time: Option<f64>,
    /// Print JSON instead of lines
    #[arg(long)]
    json: bool,
    /// Print align* blocks of LaTeX (amsmath) instead of lines
    #[arg(long, conflicts_with = "json")]
    latex: bool,
}

pub(crate) fn run(args: &ExplainArgs) -> Result<(), Failure> {
    args.drawing.input.without_picture()?;
    let mut input = SceneInput::read(&args.drawing, &args.drawing.options())?;
    if remove_what_is_laid_over(&mut input.scene) {
        eprintln!("note: explained without lines along edges and before an opaque background of one colour");
    }
    if !input.sharing().is_empty() {
        let file = input.name();
        return Err(
            format!("{file}: several cameras share the picture; expected --camera with the one to explain").into()
        );
    }
    let size = input.resize(args.size);
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::reference());
    let spawned = input.spawn(&mut app)?;
    if args.time.is_some() && !spawned.is_animated {
        return Err(format!("--time: {} has no animation", input.name()).into());
    }
    app.insert_resource(SceneTime::At(args.time.unwrap_or(0.0)));
    app.finish();
    app.cleanup();
    app.update();
    let oracle = Oracle::new(app.world_mut(), size)?.with_clamping(true).with_samples_of_camera();
    let [x, y] = args.at;
    let explained = oracle.explain(x, y).map_err(|error| Failure::new(2, format!("--at: {error}")))?;
    if args.json {
        println!("{:#}", explained.to_json());
    } else if args.latex {
        println!("{}", explained.to_latex());
    } else {
        println!("{explained}");
    }
    Ok(())
}

fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let pixel = text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    pixel.ok_or_else(|| "expected X,Y, a column and a row, such as 320,240".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels() {
        assert_eq!(parse_pixel("320,240"), Ok([320, 240]));
        assert_eq!(parse_pixel("0, 7"), Ok([0, 7]));
        for bad in ["", "1", "1,", ",1", "-1,2", "1,2,3", "1.5,2", "x,y"] {
            assert!(parse_pixel(bad).is_err(), "{bad}");
        }
    }
}
