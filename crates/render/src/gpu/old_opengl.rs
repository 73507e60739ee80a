//! Detects versions of OpenGL on which wgpu draws incorrectly.

/// From this version of OpenGL on shaders bind buffers by number.
const NUMBERED: (u32, u32) = (4, 2);

/// The reason why drawing would be incorrect, if any: OpenGL before 4.2 with compute shaders as an extension.
///
/// There wgpu (30.0) omits the numbers of buffers from its shaders because of the version, and does not set them by
/// name because of the extension, so that all buffers are the first one. wgpu asks for a context of version 3.3; Mesa
/// returns its newest one nevertheless, and NVIDIA 3.3.
pub(crate) fn unfit(info: &wgpu::AdapterInfo, flags: wgpu::DownlevelFlags) -> Option<String> {
    let found = version(&info.driver_info).filter(|&found| found < NUMBERED)?;
    let is_unfit = info.backend == wgpu::Backend::Gl && flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS);
    let (major, minor) = found;
    is_unfit.then(|| {
        format!(
            "its OpenGL is {major}.{minor} with compute shaders as an extension, by which wgpu draws with the wrong \
             buffers; expected 4.2 or later. Draw by Vulkan, or on the CPU"
        )
    })
}

/// The version in OpenGL's version string, such as `3.3.0 NVIDIA 580.159.04`; `None` for OpenGL ES, whose string begins
/// with its name.
fn version(said: &str) -> Option<(u32, u32)> {
    let mut numbers = said.split([' ', '.']).map(str::parse);
    Some((numbers.next()?.ok()?, numbers.next()?.ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use wgpu::{Backend, DownlevelFlags};

    #[test]
    fn only_old_opengl_with_new_extensions_is_unfit() {
        let reason = |backend, version: &str, flags| {
            let info = wgpu::AdapterInfo::new(wgpu::DeviceType::DiscreteGpu, backend);
            unfit(&wgpu::AdapterInfo { driver_info: version.into(), ..info }, flags)
        };
        let compute = DownlevelFlags::COMPUTE_SHADERS;
        let nvidia = reason(Backend::Gl, "3.3.0 NVIDIA 580.159.04", compute).expect("it is too old");
        assert!(nvidia.starts_with("its OpenGL is 3.3 with"), "{nvidia}");
        assert!(reason(Backend::Gl, "3.3 (Core Profile) Mesa 22.3.6", compute).is_some());
        assert_eq!(reason(Backend::Gl, "4.5 (Core Profile) Mesa 22.3.6", compute), None);
        // The numbers are set by name.
        assert_eq!(reason(Backend::Gl, "3.3.0 NVIDIA 580.159.04", DownlevelFlags::empty()), None);
        assert_eq!(reason(Backend::Gl, "OpenGL ES 3.2 Mesa 22.3.6", compute), None);
        assert_eq!(reason(Backend::Gl, "", compute), None);
        assert_eq!(reason(Backend::Vulkan, "3.3.0", compute), None);
    }
}
