//! Disks that are full or read-only, for every command that writes files: a message, and no half-written file.
//!
//! The disk is a small one in memory that only the command's own mount namespace sees. Where a system does not allow
//! that, a limit on the size of files stands for the full disk, and nothing for the read-only one.

use crate::LAYERED;
use std::process::{Command, Output};

/// A write that fails: what precedes the command in a shell, what the message must contain, and whether files can be
/// made at all. `$disk` is an empty folder.
struct Broken {
    prepare: &'static str,
    says: &'static str,
    holds_files: bool,
}

const FULL: Broken =
    Broken { prepare: "mount -t tmpfs -o size=64k none \"$disk\"", says: "No space left on device", holds_files: true };
const READ_ONLY: Broken =
    Broken { prepare: "mount -t tmpfs -o ro none \"$disk\"", says: "Read-only file system", holds_files: false };
/// A limit of the user. The program itself must ignore the signal that comes with it.
const SHORT: Broken = Broken { prepare: "ulimit -f 16", says: "File too large", holds_files: true };

/// The commands; `$disk` is where they write.
const COMMANDS: [&str; 9] = [
    "bake FILE -o \"$disk\" --size 512",
    "bake FILE -o \"$disk\" --what height,albedo --size 256 --format exr",
    "bake FILE -o \"$disk\" --as cube --size 128 --format ktx2",
    "bake FILE -o \"$disk\" --as landscape --lat 5 --lon 5 --km 50 --tiles 2 --size 253 --format r16",
    "mesh FILE -o \"$disk/mesh.glb\" --spacing 200000",
    "mesh FILE -o \"$disk/mesh.obj\" --spacing 400000 --texture 128",
    "tiles FILE -o \"$disk\" --levels 1 --cells 64",
    "coasts FILE -o \"$disk/coasts.geojson\" --spacing 50000",
    "bake FILE -o \"$disk/new/folder\" --size 512",
];

/// Runs a command on a broken disk. Its standard output names what is left on the disk.
fn run(broken: &Broken, command: &str, in_namespace: bool) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let command = command.replace("FILE", LAYERED);
    let script = format!(
        "disk={}; {} || exit 99; {} {command}; status=$?; cd \"$disk\" && find . -type f | sort; exit $status",
        folder.path().display(),
        broken.prepare,
        env!("CARGO_BIN_EXE_tellus"),
    );
    let mut shell = if in_namespace { Command::new("unshare") } else { Command::new("bash") };
    if in_namespace {
        shell.args(["-rm", "bash"]);
    }
    shell.args(["-c", &script]).current_dir(env!("CARGO_MANIFEST_DIR")).env("TELLUS_MAPS", "");
    shell.output().unwrap()
}

fn check(broken: &Broken, in_namespace: bool) {
    for command in COMMANDS {
        let Output { status, stdout, stderr } = run(broken, command, in_namespace);
        let (told, left) = (String::from_utf8(stderr).unwrap(), String::from_utf8(stdout).unwrap());
        assert_eq!(status.code(), Some(1), "{command}: {told}");
        assert!(told.starts_with("error: ") && told.contains(broken.says), "{command}: {told}");
        assert!(told.contains("tmp"), "{command}: the message names no file: {told}");
        for file in left.lines() {
            // Whole strips and tiles, with which the same command goes on, and the key of their folder.
            let is_whole = file.ends_with(".strip") || file.ends_with("tiles.key") || is_whole_tile(command, file);
            assert!(broken.holds_files && is_whole, "{command}: left behind: {file}");
        }
        // Where nothing was before, no old file is spoken of.
        assert!(!told.contains("the old file"), "{command}: {told}");
    }
}

/// A tile has its place only once it is complete; of other sets nothing is in its place before all is complete. What is
/// not complete ends with `.tmp`.
fn is_whole_tile(command: &str, file: &str) -> bool {
    command.starts_with("tiles ") && file.ends_with(".glb")
}

/// Whether a disk can be made for one command.
fn has_namespaces() -> bool {
    let folder = tempfile::tempdir().unwrap();
    let probe = format!("mount -t tmpfs -o size=64k none {}", folder.path().display());
    let status = Command::new("unshare").args(["-rm", "bash", "-c", &probe]).output();
    status.is_ok_and(|output| output.status.success())
}

#[test]
fn a_full_disk_is_said_and_leaves_nothing_half_written() {
    if has_namespaces() {
        check(&FULL, true);
    }
    check(&SHORT, false);
}

/// A bake that cannot fit is refused with both numbers, before anything is made.
#[test]
fn a_disk_that_is_too_small_is_said_beforehand() {
    if !has_namespaces() {
        return;
    }
    for command in COMMANDS.into_iter().filter(|command| command.starts_with("bake ") || command.starts_with("tiles "))
    {
        let Output { stdout, stderr, .. } = run(&FULL, command, true);
        let (told, left) = (String::from_utf8(stderr).unwrap(), String::from_utf8(stdout).unwrap());
        let is_said = told.contains("it takes at least ") && told.contains("and 0.1 MiB are free");
        assert!(is_said && left.is_empty(), "{command}: {told}{left}");
    }
}

#[test]
fn a_read_only_disk_is_said() {
    if has_namespaces() {
        check(&READ_ONLY, true);
    }
}
