//! The `MuJoCo` library, loaded at first use: a program with this engine starts without the library, and reports it as missing at first
//! use.
//!
//! The crate `mujoco-rs` calls the functions of the library by their names. Here each of them is defined under its name and passes the call
//! on to the loaded library, so that no program is linked with it.
#![expect(non_snake_case, reason = "the names are those of the library")]
use libloading::Library;
use mujoco_rs::mujoco_c::{mjData, mjLogConfig, mjModel, mjSpec, mjVFS, mjfLogHandler, mjtNum};
use std::env::{current_exe, var_os};
use std::ffi::{c_char, c_int, c_void};
use std::path::PathBuf;
use std::sync::OnceLock;

/// File of the library.
pub(crate) const FILE: &str = "libmujoco.so.3.17.0";
/// Variable that names the folder of the library.
const FOLDER: &str = "SERVOBENCH_MUJOCO";
/// Folders of the library from that of the program: of an archive, of a build, of a test in `deps`.
const FROM_PROGRAM: [&str; 3] = ["../native/lib", "../../native/lib", "."];

static LOADED: OnceLock<Result<Functions, String>> = OnceLock::new();

/// Path of the library; `None` where it is not installed.
fn place() -> Option<PathBuf> {
    if let Some(folder) = var_os(FOLDER) {
        return Some(PathBuf::from(folder).join(FILE)).filter(|file| file.is_file());
    }
    let program = current_exe().ok()?;
    let folder = program.parent()?;
    FROM_PROGRAM.iter().map(|way| folder.join(way).join(FILE)).find(|file| file.is_file())
}

/// Reason why the library cannot be used; `None` where it is installed.
pub(crate) fn missing() -> Option<String> {
    if place().is_some() {
        return None;
    }
    Some(format!(
        "the MuJoCo library `{FILE}` is not installed: put it into `native/lib` beside the folder of the program, as in the archive, or name \
         its folder in {FOLDER}"
    ))
}

/// Loads the library, once.
///
/// # Errors
/// The reason why it cannot be loaded, in words.
pub(crate) fn load() -> Result<(), String> {
    loaded().map(drop).map_err(str::to_owned)
}

/// The functions of the library. The engine loads it before it calls one; a caller without a loaded library ends its process with the
/// reason.
fn functions() -> &'static Functions {
    match loaded() {
        Ok(functions) => functions,
        Err(why) => panic!("{why}"),
    }
}

fn loaded() -> Result<&'static Functions, &'static str> {
    let load = || Functions::of(&place().ok_or_else(|| missing().unwrap_or_default())?);
    LOADED.get_or_init(load).as_ref().map_err(String::as_str)
}

/// Functions of the library by their names, with their types in C.
macro_rules! functions {
    ($(fn $name:ident($($argument:ident: $type:ty),*) $(-> $result:ty)?;)+) => {
        struct Functions {
            $($name: unsafe extern "C" fn($($type),*) $(-> $result)?,)+
        }

        impl Functions {
            fn of(file: &std::path::Path) -> Result<Self, String> {
                let wrong = |error: libloading::Error| format!("the MuJoCo library `{}` cannot be loaded: {error}", file.display());
                #[expect(unsafe_code, reason = "a library is loaded, and its functions are taken for what its headers declare")]
                // SAFETY: the library is MuJoCo's, whose initialisers have no requirements; the types of its functions are those of the
                // headers of this version, from which `mujoco-rs` has them, too. It is never unloaded.
                unsafe {
                    let library = Box::leak(Box::new(Library::new(file).map_err(wrong)?));
                    Ok(Self { $($name: *library.get(concat!(stringify!($name), "\0").as_bytes()).map_err(wrong)?,)+ })
                }
            }
        }

        $(
            #[expect(unsafe_code, reason = "the name is that of the library, whose caller keeps its requirements")]
            #[unsafe(no_mangle)]
            unsafe extern "C" fn $name($($argument: $type),*) $(-> $result)? {
                // SAFETY: the caller keeps the requirements of the library for the same call.
                unsafe { (functions().$name)($($argument),*) }
            }
        )+
    };
}

functions! {
    fn mj_addBufferVFS(vfs: *mut mjVFS, name: *const c_char, buffer: *const c_void, size: c_int) -> c_int;
    fn mj_compile(spec: *mut mjSpec, vfs: *const mjVFS) -> *mut mjModel;
    fn mj_defaultVFS(vfs: *mut mjVFS);
    fn mj_deleteData(data: *mut mjData);
    fn mj_deleteModel(model: *mut mjModel);
    fn mj_deleteSpec(spec: *mut mjSpec);
    fn mj_deleteVFS(vfs: *mut mjVFS);
    fn mj_forward(model: *const mjModel, data: *mut mjData);
    fn mj_getState(model: *const mjModel, data: *const mjData, state: *mut mjtNum, parts: c_int);
    fn mj_id2name(model: *const mjModel, kind: c_int, id: c_int) -> *const c_char;
    fn mj_kinematics(model: *const mjModel, data: *mut mjData);
    fn mj_loadXML(file: *const c_char, vfs: *const mjVFS, error: *mut c_char, size: c_int) -> *mut mjModel;
    fn mj_makeData(model: *const mjModel) -> *mut mjData;
    fn mj_parseXML(file: *const c_char, vfs: *const mjVFS, error: *mut c_char, size: c_int) -> *mut mjSpec;
    fn mj_setState(model: *const mjModel, data: *mut mjData, state: *const mjtNum, parts: c_int);
    fn mj_stateSize(model: *const mjModel, parts: c_int) -> c_int;
    fn mj_step(model: *const mjModel, data: *mut mjData);
    fn mj_version() -> c_int;
    fn mjs_getError(spec: *mut mjSpec) -> *const c_char;
    fn mju_getLogConfig() -> mjLogConfig;
    fn mju_setLogConfig(config: mjLogConfig);
    fn mju_setLogHandler(handler: mjfLogHandler) -> mjfLogHandler;
}
