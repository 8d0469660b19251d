//! The parts of a table, in the order that lets each see what it may use.

use super::levels::Expected;
use super::{Finder, Kind, SymbolId};
use crate::diag::Spanned;
use crate::table::draw::Draw;
use crate::table::{
    Assumption, ConstantValue, ContinuityKind, Domain, Function, FunctionBody, Image, Output, ResultMap,
};

impl<'t> Finder<'t> {
    /// Looks through the whole table.
    pub(super) fn table(&mut self) {
        self.declarations();
        self.inputs();
        self.constants();
        let table = self.table;
        for named in &table.names {
            self.expr(&named.value, Expected::Anything);
        }
        for symmetry in &table.symmetries {
            self.map(&symmetry.map);
            if let Some(result) = &symmetry.result {
                self.result_map(result, Some(&table.output.value));
            }
        }
        self.assumptions(&table.assumptions);
        for (input, draw) in &table.draw {
            self.mention_input(input);
            self.draw(&input.value, draw);
        }
        for continuity in &table.continuity {
            match &continuity.kind {
                ContinuityKind::Border { when, map, free } => {
                    self.expr(when, Expected::Anything);
                    self.map(map);
                    free.iter().for_each(|input| self.mention_input(input));
                }
                ContinuityKind::Switch(inputs) => inputs.iter().for_each(|input| self.mention_input(input)),
            }
        }
        for claim in &table.claims {
            claim.exprs().for_each(|side| self.expr(side, Expected::Anything));
            claim.inputs.iter().for_each(|input| self.mention_input(input));
        }
        for helper in &table.helpers {
            let symbol = self.callables.get(helper.name.value.as_str()).copied();
            let of_helper = |symbol: &super::Symbol| symbol.kind == Kind::Parameter;
            let parameters = self.symbols.iter().enumerate().filter(|(_, s)| of_helper(s) && s.of == symbol);
            let parameters: Vec<_> = parameters.map(|(id, s)| (s.name.clone(), SymbolId(id), None)).collect();
            self.locals = parameters;
            self.in_helper = true;
            self.lines(&helper.lines, Expected::Anything);
            self.in_helper = false;
            self.locals.clear();
        }
        self.declare_cases(&table.cases);
        let output = Self::result(&table.output.value);
        self.mention_output(&table.output.value);
        if table.functions.is_empty() {
            self.rows(&table.cases, &table.default, output);
        }
        table.functions.iter().for_each(|function| self.function(function));
        self.sets_of_values();
    }

    /// Notes what stands for a level, now that all sets are known.
    fn sets_of_values(&mut self) {
        let table = self.table;
        for (name, symbol) in self.inputs.clone() {
            self.symbols[symbol.0].set = self.set_of_input(name);
        }
        for named in &table.names {
            if let Some(symbol) = self.values.get(named.name.value.as_str()).copied() {
                self.symbols[symbol.0].set = self.set_of(&named.value);
            }
        }
    }

    /// Enters everything that has a name in the whole table.
    fn declarations(&mut self) {
        let table = self.table;
        for import in &table.imports {
            let symbol = self.declare(Kind::Import, &import.alias, import.path.span, "");
            self.imports.insert(&import.alias.value, symbol);
            if let Some(imported) = &import.table {
                self.symbols[symbol.0].doc = imported.title.clone();
            }
        }
        for (name, levels) in &table.levels {
            let whole = levels.iter().fold(name.span, |whole, level| whole.to(level.code.span));
            let set = self.declare(Kind::Set, name, whole, "");
            self.sets.insert(&name.value, set);
            self.declare_levels(set, levels);
        }
        for input in &table.inputs {
            let symbol = self.declare(Kind::Input, &input.name, input.domain.span, &input.doc);
            self.inputs.insert(&input.name.value, symbol);
            if !input.parameters.is_empty() {
                self.callables.insert(&input.name.value, symbol);
            }
            if let Domain::Levels(levels) = &input.domain.value {
                self.declare_levels(symbol, levels);
            }
        }
        for group in &table.groups {
            let whole = group.members.iter().fold(group.name.span, |whole, member| whole.to(member.span));
            let symbol = self.declare(Kind::Group, &group.name, whole, "");
            self.values.insert(&group.name.value, symbol);
        }
        for constant in &table.constants {
            let symbol = self.declare(Kind::Constant, &constant.name, constant.name.span, "");
            self.values.insert(&constant.name.value, symbol);
        }
        for named in &table.names {
            let symbol = self.declare(Kind::Name, &named.name, named.value.span, "");
            self.values.insert(&named.name.value, symbol);
        }
        for helper in &table.helpers {
            let whole = helper.lines.iter().fold(helper.name.span, |whole, line| whole.to(line.value.span));
            let symbol = self.declare(Kind::Helper, &helper.name, whole, "");
            for parameter in &helper.parameters {
                self.declare_in(symbol, Kind::Parameter, parameter, parameter.span);
            }
            self.callables.insert(&helper.name.value, symbol);
        }
        for function in &table.functions {
            let whole = match &function.body {
                FunctionBody::Value(value) => value.span,
                FunctionBody::Cases { default, .. } => default.span,
            };
            let symbol = self.declare(Kind::Function, &function.name, whole, &function.doc);
            self.callables.insert(&function.name.value, symbol);
        }
        for symmetry in &table.symmetries {
            let whole = symmetry.map.iter().fold(symmetry.name.span, |whole, (input, _)| whole.to(input.span));
            let symbol = self.declare(Kind::Symmetry, &symmetry.name, whole, &symmetry.doc);
            self.symmetries.insert(&symmetry.name.value, symbol);
        }
        for assumption in &table.assumptions {
            self.declare(Kind::Assumption, &assumption.name, assumption.condition.span, &assumption.doc);
        }
        for continuity in &table.continuity {
            self.declare(Kind::Continuity, &continuity.name, continuity.name.span, &continuity.doc);
        }
        for claim in &table.claims {
            self.declare(Kind::Claim, &claim.name, claim.span, &claim.doc);
        }
    }

    fn inputs(&mut self) {
        let table = self.table;
        for input in &table.inputs {
            if let Domain::LevelsOf(set) = &input.domain.value {
                self.mention_set(set);
            }
        }
        // Defaults may be levels of sets that only now are known.
        for input in &table.inputs {
            if let Some(default) = &input.default {
                let set = self.set_of_input(&input.name.value);
                self.expr(default, set.map_or(Expected::Anything, Expected::Level));
            }
        }
        for group in &table.groups {
            group.members.iter().for_each(|member| self.mention_input(member));
        }
    }

    fn constants(&mut self) {
        let table = self.table;
        for constant in &table.constants {
            match &constant.value {
                ConstantValue::Number(value) => self.expr(value, Expected::Anything),
                ConstantValue::List(items) => {
                    items.iter().flatten().for_each(|number| self.expr(number, Expected::Anything));
                }
                ConstantValue::Levels { of, items } => {
                    let set = self.mention_set(of);
                    items.iter().flatten().for_each(|level| self.mention_spelt(level, set));
                }
                ConstantValue::File(..) => {}
            }
        }
    }

    fn assumptions(&mut self, assumptions: &'t [Assumption]) {
        for assumption in assumptions {
            self.expr(&assumption.condition, Expected::Anything);
        }
    }

    /// The inputs that a symmetry or border maps, and what to.
    fn map(&mut self, map: &'t [(Spanned<String>, Image)]) {
        for (input, image) in map {
            self.mention_input(input);
            let own = self.set_of_input(&input.value);
            match image {
                Image::Expr(expr) => self.expr(expr, own.map_or(Expected::Anything, Expected::Level)),
                Image::Levels { from, map } => {
                    let old = match from {
                        Some(from) => {
                            self.mention_input(from);
                            self.set_of_input(&from.value)
                        }
                        None => own,
                    };
                    for (before, after) in map {
                        self.mention_level(before.span, &before.value, old);
                        self.mention_level(after.span, &after.value, own);
                    }
                }
            }
        }
    }

    fn result_map(&mut self, map: &'t ResultMap, output: Option<&'t Output<Spanned<String>>>) {
        match map {
            ResultMap::Expr(expr) => self.expr(expr, output.map_or(Expected::Anything, Expected::Result)),
            ResultMap::Parts(_, parts) => {
                for (name, part) in parts {
                    let field = match output {
                        Some(Output::Record(fields)) => {
                            fields.iter().find(|(field, _)| *field == name.value).map(|(_, of)| of)
                        }
                        other => {
                            let set = other.and_then(|output| self.set_of_output(output));
                            self.mention_level(name.span, &name.value, set);
                            other
                        }
                    };
                    self.result_map(part, field);
                }
            }
        }
    }

    fn draw(&mut self, input: &str, draw: &Draw) {
        let set = self.set_of_input(input);
        match draw {
            Draw::Across | Draw::Down => {}
            Draw::Sides { levels, .. } => {
                levels.iter().for_each(|(level, _)| self.mention_level(level.span, &level.value, set));
            }
            Draw::Dark(levels) => levels.iter().for_each(|level| self.mention_level(level.span, &level.value, set)),
            Draw::Run { along, ends } => {
                self.mention_input(along);
                ends.iter().for_each(|(level, _)| self.mention_level(level.span, &level.value, set));
            }
            Draw::Position(of) | Draw::Strong(of) => self.mention_input(of),
        }
    }

    /// The sets that the output names.
    fn mention_output(&mut self, output: &'t Output<Spanned<String>>) {
        match output {
            Output::Enumeration(set) => {
                self.mention_set(set);
            }
            Output::List { of, .. } => self.mention_output(of),
            Output::Record(fields) => fields.iter().for_each(|(_, of)| self.mention_output(of)),
            Output::Number(_) | Output::Vector(..) | Output::Bool | Output::Int(..) | Output::U32 => {}
        }
    }

    fn function(&mut self, function: &'t Function) {
        function.parameters.iter().for_each(|parameter| self.mention_input(parameter));
        let owner = self.callables.get(function.name.value.as_str()).copied();
        for binding in &function.bindings {
            self.expr(&binding.value, Expected::Anything);
            let set = self.set_of(&binding.value);
            let local = self.declare(Kind::Local, &binding.name, binding.value.span, "");
            self.symbols[local.0].of = owner;
            self.locals.push((binding.name.value.clone(), local, set));
        }
        match &function.body {
            FunctionBody::Value(value) => self.expr(value, Expected::Anything),
            FunctionBody::Cases { cases, default } => {
                self.declare_cases(cases);
                for case in cases {
                    let symbol = self.cases.get(&case.id.value).copied();
                    if let Some(symbol) = symbol {
                        self.symbols[symbol.0].of = owner;
                    }
                }
                self.rows(cases, default, Expected::Anything);
            }
        }
        self.assumptions(&function.domain);
        for limit in &function.limits {
            self.given(&limit.at);
            self.expr(&limit.value, Expected::Anything);
        }
        if let Some(accuracy) = &function.accuracy {
            self.expr(&accuracy.scale, Expected::Anything);
        }
        function.examples.iter().for_each(|example| self.example(example, Expected::Anything));
        self.locals.clear();
    }
}
