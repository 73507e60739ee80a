//! Shader templates: each pipeline gets the part of a text that it uses.

use std::borrow::Cow;
use wgpu::naga::back::pipeline_constants::process_overrides;
use wgpu::naga::compact::{KeepUnused, compact};
use wgpu::naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use wgpu::naga::{self, Arena, Block, Constant, Expression, Handle, Literal, Module, ShaderStage, Statement};

/// A text, read once.
///
/// A driver would remove by itself the code that a pipeline's constants rule out, but only after inlining every
/// function call: for a draw with one image that includes the filters of all eight kinds.
pub(crate) struct Template {
    module: Module,
    info: ModuleInfo,
}

/// An entry point of a pipeline, with its constants.
pub(crate) struct EntryPoint<'a> {
    pub(crate) stage: ShaderStage,
    pub(crate) name: &'static str,
    pub(crate) constants: &'a [(&'static str, f64)],
}

impl Template {
    /// Reads one of the project's own texts, which the tests show to be valid.
    pub(crate) fn new(text: &str) -> Self {
        let module =
            naga::front::wgsl::parse_str(text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)));
        let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module);
        let info = info.unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)));
        Self { module, info }
    }

    /// The shader of one entry point alone, without code that its constants rule out.
    pub(crate) fn shader(&self, gpu: &wgpu::Device, of: EntryPoint) -> wgpu::ShaderModule {
        gpu.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(of.name),
            source: wgpu::ShaderSource::Naga(Cow::Owned(self.module_of(of))),
        })
    }

    /// The same as a module of naga.
    pub(crate) fn module_of(&self, EntryPoint { stage, name, constants }: EntryPoint) -> Module {
        let constants = constants.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
        let fixed = process_overrides(&self.module, &self.info, Some((stage, name)), &constants);
        let (fixed, _) = fixed.unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut module = fixed.into_owned();
        leave_out_what_is_never(&mut module);
        module
    }
}

/// Empties branches that known conditions rule out, and drops unreachable functions.
fn leave_out_what_is_never(module: &mut Module) {
    let Module { functions, entry_points, constants, global_expressions, .. } = module;
    let all = functions.iter_mut().map(|(_, function)| function);
    for function in all.chain(entry_points.iter_mut().map(|entry| &mut entry.function)) {
        let known = Known { expressions: &function.expressions, constants, global_expressions };
        known.empty_branches(&mut function.body);
        // A name would keep functions that were called in an emptied branch.
        function.named_expressions.clear();
    }
    compact(module, KeepUnused::No);
}

/// Facts about a function's expressions.
struct Known<'a> {
    expressions: &'a Arena<Expression>,
    constants: &'a Arena<Constant>,
    global_expressions: &'a Arena<Expression>,
}

impl Known<'_> {
    fn truth(&self, of: Handle<Expression>) -> Option<bool> {
        let literal = |expression: &Expression| match expression {
            Expression::Literal(Literal::Bool(truth)) => Some(*truth),
            _ => None,
        };
        match &self.expressions[of] {
            Expression::Constant(constant) => literal(&self.global_expressions[self.constants[*constant].init]),
            expression => literal(expression),
        }
    }

    fn empty_branches(&self, block: &mut Block) {
        for statement in block.iter_mut() {
            match statement {
                Statement::If { condition, accept, reject } => {
                    match self.truth(*condition) {
                        Some(true) => *reject = Block::new(),
                        Some(false) => *accept = Block::new(),
                        None => {}
                    }
                    self.empty_branches(accept);
                    self.empty_branches(reject);
                }
                Statement::Block(block) => self.empty_branches(block),
                Statement::Switch { cases, .. } => {
                    for case in cases {
                        self.empty_branches(&mut case.body);
                    }
                }
                Statement::Loop { body, continuing, .. } => {
                    self.empty_branches(body);
                    self.empty_branches(continuing);
                }
                _ => {}
            }
        }
    }
}
