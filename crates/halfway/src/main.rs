//! The `halfway` command: scenes and models to pictures, to a window, to figures.

mod command;

fn main() -> std::process::ExitCode {
    quiet_driver();
    command::main()
}

/// Mesa's Vulkan drivers look for a Wayland display while adapters are listed. Without a session, where `XDG_RUNTIME_DIR`
/// is not set, the Wayland library then prints an error that is none; with any folder there, it finds nothing in silence.
#[expect(unsafe_code, reason = "the environment may be written while there is one thread, which is now")]
fn quiet_driver() {
    const FOLDER: &str = "XDG_RUNTIME_DIR";
    if cfg!(target_os = "linux") && std::env::var_os(FOLDER).is_none() && std::env::var_os("WAYLAND_DISPLAY").is_none()
    {
        // SAFETY: the first statement of `main`; no other thread exists that could read the environment.
        unsafe { std::env::set_var(FOLDER, std::env::temp_dir()) };
    }
}
