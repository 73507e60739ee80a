//! The `halfway` command: scenes and models to pictures, to a window, to figures.

mod command;

fn main() -> std::process::ExitCode {
    command::main()
}
