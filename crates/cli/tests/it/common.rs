//! A folder for each test, and the program run in it.

use kirkas_images::{Attribute, ChannelData, Image, read_exr};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// The smallest scene worth a picture.
pub const BALL: &str = r#"
[film]
width = 24
height = 16

[sampler]
samples = 4

[cameras.main]
type = "perspective"

[lights.lamp]
type = "point"
position = [2, 3, 4]
intensity = 20

[materials.red]
type = "lambert"
reflectance = [0.8, 0.2, 0.1]

[objects.ball]
type = "sphere"
material = "red"
"#;

/// Every effect at once: glossy, glass, soft shadows, motion, lens, light groups.
pub const EVERYTHING: &str = r#"
[film]
width = 40
height = 36
light_groups = true

[sampler]
samples = 8

[integrator]
type = "whitted"
max_depth = 4
glossy_samples = 2

[background]
type = "gradient"
stops = [[-1.0, 0.1], [1.0, [0.3, 0.5, 0.9]]]

[cameras.main]
type = "thin_lens"
position = [0.5, 1.5, 5]
aperture_radius = 0.1
focus_distance = 5
shutter = [0, 1]

[lights.lamp]
type = "point"
position = [2, 3, 4]
intensity = 10

[textures.squares]
type = "checker"
mapping = "solid"

[materials.floor]
type = "lambert"
reflectance = "squares"

[materials.brushed]
type = "rough_mirror"
roughness = 0.3

[materials.glass]
type = "dielectric"

[materials.frosted]
type = "rough_dielectric"

[materials.shine]
type = "emitter"
intensity = 5
samples = 2

[objects.floor]
type = "plane"
point = [0, -1, 0]
material = "floor"

[objects.mirror]
type = "sphere"
material = "brushed"
center = [-1.2, 0, 0]
motion = [{ time = 0, transform = [{ translate = [0, 0, 0] }] }, { time = 1, transform = [{ translate = [0, 0.4, 0] }] }]

[objects.glass]
type = "sphere"
material = "glass"
center = [1.2, 0, 0]

[objects.frosted]
type = "sphere"
material = "frosted"
center = [0, 0, 1.5]
radius = 0.4

[objects.lamp]
type = "rectangle"
center = [0, 3, 0]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
material = "shine"
"#;

/// A folder of its own, empty at the start.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli").join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    /// With this scene as `scene.toml`.
    pub fn with_scene(name: &str, scene: &str) -> Self {
        Self::new(name).file("scene.toml", scene)
    }

    pub fn file(self, name: &str, text: impl AsRef<[u8]>) -> Self {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
        self
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_kirkas"));
        command.current_dir(&self.0).args(args).env("NO_COLOR", "1").stdin(Stdio::null());
        command
    }

    /// Run to the end.
    pub fn run(&self, args: &[&str]) -> Done {
        let out = self.command(args).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Done { code: out.status.code(), stdout: text(out.stdout), stderr: text(out.stderr) }
    }

    /// Run to the end, which must be a good one.
    pub fn ok(&self, args: &[&str]) -> Done {
        let done = self.run(args);
        assert_eq!(done.code, Some(0), "{args:?}\n{}", done.stderr);
        done
    }

    pub fn start(&self, args: &[&str]) -> Child {
        self.command(args).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
    }

    pub fn exr(&self, name: &str) -> Image {
        read_exr(&std::fs::read(self.path(name)).unwrap()).unwrap()
    }

    pub fn names(&self) -> Vec<String> {
        let mut names: Vec<String> =
            std::fs::read_dir(&self.0).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// What a run left.
pub struct Done {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// All channels, bit for bit.
pub fn bits(image: &Image) -> BTreeMap<String, Vec<u32>> {
    let bits = |data: &ChannelData| match data {
        ChannelData::F16(v) | ChannelData::F32(v) => v.iter().map(|x| x.to_bits()).collect(),
        ChannelData::U32(v) => v.clone(),
    };
    image.channels.iter().map(|c| (c.name.clone(), bits(&c.data))).collect()
}

/// The header but for the command that was typed.
pub fn header(image: &Image) -> BTreeMap<String, Attribute> {
    let mut all = image.attributes.clone();
    assert!(all.remove("kirkas.argv").is_some());
    all
}
