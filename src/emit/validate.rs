//! naga at work: parses and validates the emitted text, and translates it
//! further. Only this module and `reflect` name naga.

use naga::ShaderStage;
use naga::back::{hlsl, msl, spv};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

use crate::diag::{Diagnostic, Failure, codes};
use crate::program::Program;

/// naga recurses over statements and expressions; a generous stack keeps large
/// modules from overflowing it, also in builds without optimisation.
const STACK: usize = 256 << 20;

/// A module that naga parsed and validated.
#[derive(Debug)]
pub struct Validated {
    /// The module.
    pub module: naga::Module,
    /// The results of its validation.
    pub info: ModuleInfo,
}

/// Languages that naga writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Translated {
    /// SPIR-V 1.1.
    SpirV,
    /// HLSL for shader model 5.0: Direct3D 11.
    Hlsl,
    /// MSL 2.0.
    Msl,
}

/// Parses and validates WGSL.
///
/// # Errors
/// With naga's message and the generated line it is about.
pub fn wgsl_module(program: &Program, source: &str) -> Result<Validated, Failure> {
    with_stack(|| read_wgsl(source).map_err(|message| invalid(program, "WGSL", &message)))
}

/// Parses and validates WGSL that comes from no table: the skeleton of a pass, called `name` in messages.
///
/// # Errors
/// With naga's message and the line it is about.
pub fn wgsl_text(name: &str, source: &str) -> Result<Validated, Failure> {
    with_stack(|| {
        read_wgsl(source).map_err(|message| {
            let error = Diagnostic::error(codes::INVALID_OUTPUT, format!("naga refuses the WGSL of the pass `{name}`"));
            Failure::bare("", error.help(message.trim_end().to_owned()).help("please report this"))
        })
    })
}

fn read_wgsl(source: &str) -> Result<Validated, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    validated(source, module)
}

/// Parses and validates GLSL 450, as a compute shader.
///
/// # Errors
/// With naga's message and the generated line it is about.
pub fn glsl_module(program: &Program, source: &str) -> Result<Validated, Failure> {
    with_stack(|| {
        let options = naga::front::glsl::Options::from(ShaderStage::Compute);
        let module = naga::front::glsl::Frontend::default()
            .parse(&options, source)
            .map_err(|error| invalid(program, "GLSL", &error.emit_to_string(source)))?;
        validated(source, module).map_err(|message| invalid(program, "GLSL", &message))
    })
}

fn validated(source: &str, module: naga::Module) -> Result<Validated, String> {
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string(source))?;
    Ok(Validated { module, info })
}

/// Writes a validated module in another language.
///
/// # Errors
/// When naga cannot express the module there.
pub fn translate(program: &Program, validated: &Validated, to: Translated) -> Result<Vec<u8>, Failure> {
    let (module, info) = (&validated.module, &validated.info);
    with_stack(|| match to {
        Translated::SpirV => {
            let options = spv::Options { flags: spv::WriterFlags::empty(), ..spv::Options::default() };
            let words = spv::write_vec(module, info, &options, None)
                .map_err(|error| invalid(program, "SPIR-V", &error.to_string()))?;
            Ok(words.iter().flat_map(|word| word.to_le_bytes()).collect())
        }
        Translated::Hlsl => {
            let options = hlsl::Options { shader_model: hlsl::ShaderModel::V5_0, ..hlsl::Options::default() };
            let pipeline = hlsl::PipelineOptions::default();
            let mut out = String::new();
            hlsl::Writer::new(&mut out, &options, &pipeline)
                .write(module, info, None)
                .map_err(|error| invalid(program, "HLSL", &error.to_string()))?;
            Ok(out.into_bytes())
        }
        Translated::Msl => {
            let options = msl::Options { lang_version: (2, 0), ..msl::Options::default() };
            let (out, _) = msl::write_string(module, info, &options, &msl::PipelineOptions::default())
                .map_err(|error| invalid(program, "MSL", &error.to_string()))?;
            Ok(out.into_bytes())
        }
    })
}

fn invalid(program: &Program, language: &str, message: &str) -> Failure {
    let headline = format!("naga refuses the {language} that was generated for `{}`", program.name);
    let diagnostic = Diagnostic::error(codes::INVALID_OUTPUT, headline)
        .help(message.trim_end().to_owned())
        .help("nothing was written; please report this: whatever a table says, the output must be valid");
    Failure::new(program.source.clone(), diagnostic)
}

/// Runs `work` on a thread with a large stack, or here if none can be had.
fn with_stack<T: Send>(work: impl FnOnce() -> Result<T, Failure> + Send) -> Result<T, Failure> {
    if cfg!(target_family = "wasm") {
        // No threads there; the stack of the one that there is was chosen when the module was linked.
        return work();
    }
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work);
        let joined = thread.map_err(|error| error.to_string()).and_then(|handle| {
            handle.join().map_err(|panic| {
                let text = panic.downcast_ref::<&str>().map(ToString::to_string);
                text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "panicked".to_owned())
            })
        });
        joined.unwrap_or_else(|reason| {
            let diagnostic = Diagnostic::error(codes::INVALID_OUTPUT, format!("naga failed: {reason}"));
            Err(Failure::bare("", diagnostic))
        })
    })
}
