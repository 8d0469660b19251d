//! Tables of functions, and the tables that others import.

use super::expression::{Callable, Scope, Type, Visible};
use super::{Field, Maker, Written, fields, layout, list, map};
use crate::choices::Choices;

/// Makes a table of functions.
pub(super) fn table(choices: &mut Choices<'_>) -> Written {
    let mut maker = Maker::new(choices);
    let mut beside = Vec::new();
    let mut list: Vec<Field> = vec![("name", "\"t\"".to_owned())];
    if maker.choices.one_in(6) {
        let (imports, file) = maker.imports();
        list.push(("imports", imports));
        beside.push(file);
    }
    list.extend(maker.library());
    list.push(("language", maker.language()));
    let list = maker.choices.shuffled(list);
    let text = layout::spread(maker.choices, &format!("Table({})", fields(&list)));
    Written { text, beside }
}

impl Maker<'_, '_> {
    /// The version of the language that the table so far is written in.
    pub(super) fn language(&mut self) -> String {
        (if self.later || self.modern || self.choices.either() { "2" } else { "1" }).to_owned()
    }

    /// What a table of functions has beside its name.
    fn library(&mut self) -> Vec<Field> {
        let mut list: Vec<Field> = Vec::new();
        let inputs = self.declare_inputs(false);
        list.push(("inputs", inputs));
        if self.choices.either() {
            list.push(("constants", self.constants()));
        }
        if self.choices.either() {
            list.push(("helpers", self.helpers(2)));
        }
        if self.choices.one_in(3) {
            list.push(("names", self.names(2)));
        }
        let mut functions = Vec::new();
        for _ in 0..self.choices.within(1, 3) {
            let name = self.plain_name("f");
            let text = self.function(&name);
            functions.push((name, text));
        }
        list.push(("functions", map(&functions)));
        list
    }

    fn function(&mut self, name: &str) -> String {
        let mut list: Vec<Field> = Vec::new();
        // Names of the table need their inputs, so a function takes all inputs if it could use any.
        let all: Vec<usize> = (0..self.inputs.len()).collect();
        let named =
            self.scope.visible.iter().any(|visible| visible.text.starts_with("n_") || visible.text.starts_with("n."));
        let taken = if named { all } else { self.choices.some(&all) };
        let parameters: Vec<(String, Type)> =
            taken.iter().map(|place| (self.inputs[*place].name.clone(), self.inputs[*place].kind.ty())).collect();
        let quoted: Vec<String> = parameters.iter().map(|(name, _)| format!("\"{name}\"")).collect();
        list.push(("parameters", super::list(&quoted)));
        let mut scope = self.scope.clone();
        scope.visible.retain(|visible| !visible.input || parameters.iter().any(|(name, _)| *name == visible.text));
        // A function that is called by name takes its missing parameters from where the call stands.
        scope
            .callable
            .retain(|callable| !callable.by_name || callable.parameters.iter().all(|p| parameters.contains(p)));
        if self.choices.either() {
            let mut lets = Vec::new();
            for _ in 0..self.choices.within(1, 2) {
                let name = self.plain_name("t");
                lets.push((name.clone(), self.quoted(&scope, &Type::Number, 2)));
                scope.add(Visible { text: name, ty: Type::Number, input: false });
            }
            list.push(("let", map(&lets)));
        }
        let gives = match self.choices.below(4) {
            0 | 1 => Type::Number,
            2 => Type::Vector(self.choices.within(2, 4)),
            _ => Type::numbers(&["exact", "close"]),
        };
        match self.choices.one_in(4) {
            false => list.push(("value", self.quoted(&scope, &gives, 3))),
            true => {
                let cases = (0..self.choices.within(1, 3)).map(|number| self.function_case(&scope, &gives, number));
                let cases: Vec<String> = cases.collect();
                list.push(("cases", super::list(&cases)));
                list.push(("default", self.quoted(&scope, &gives, 1)));
            }
        }
        self.claims(&mut list, &scope, &parameters, &gives);
        let list = self.choices.shuffled(list);
        self.scope.callable.push(Callable { name: name.to_owned(), parameters, gives, by_name: true });
        format!("Function({})", fields(&list))
    }

    fn function_case(&mut self, scope: &Scope, gives: &Type, number: usize) -> String {
        let guard = self.guard(scope, 1);
        let value = match self.choices.one_in(3) {
            false => format!("value: {}", self.quoted(scope, gives, 2)),
            true => {
                let lines = self.lines(scope, scope, gives, 1);
                format!("lines: {}", list(&lines))
            }
        };
        format!("Case(id: {number}, when: {guard}, {value})")
    }

    /// What a function says of itself.
    fn claims(&mut self, list: &mut Vec<Field>, scope: &Scope, parameters: &[(String, Type)], gives: &Type) {
        if self.choices.one_in(3) {
            list.push(("doc", self.doc()));
        }
        if self.choices.one_in(6) {
            list.push(("section", "\"B.2\"".to_owned()));
        }
        if self.choices.one_in(6) {
            let condition = self.guard(scope, 1);
            list.push(("domain", format!("{{\"sure\": ({condition}, \"or nothing is said\")}}")));
        }
        if self.choices.one_in(6) {
            list.push(("error", format!("(times: {}, scale: \"1\")", self.choices.pick(&["4", "1000"]))));
        }
        let number = parameters.iter().find(|(_, ty)| *ty == Type::Number);
        if let (Some((name, _)), true) = (number, self.choices.one_in(6)) {
            let value = self.quoted(scope, gives, 0);
            list.push(("limits", format!("[(at: {{\"{name}\": 0}}, value: {value})]")));
        }
    }

    /// A table of cases to import: what is written here, and the file.
    pub(super) fn import_of_cases(&mut self) -> (String, (String, String)) {
        let mut other = Maker::new(self.choices);
        other.names = 700;
        other.fuel = 20;
        let draft = other.draft(false);
        let text = draft.plain().replacen("name: \"t\"", "name: \"other\"", 1);
        let inputs = other.inputs.iter().map(|input| (input.name.clone(), input.kind.ty()));
        let inputs: Vec<(String, Type)> = inputs.collect();
        // Levels of another table are of sets that are not known here.
        let plain = |ty: &Type| matches!(ty, Type::Number | Type::Condition | Type::Vector(_));
        let gives = other.output.clone();
        if plain(&gives) && inputs.iter().all(|(_, ty)| plain(ty)) {
            self.scope.callable.push(Callable { name: "im".to_owned(), parameters: inputs, gives, by_name: false });
        }
        ("{\"im\": \"other.ron\"}".to_owned(), ("other.ron".to_owned(), text))
    }

    /// A table to import: what is written here, and the file.
    pub(super) fn imports(&mut self) -> (String, (String, String)) {
        let mut other = Maker::new(self.choices);
        // Names that differ from those here.
        other.names = 700;
        other.fuel = 20;
        let mut list: Vec<Field> = vec![("name", "\"other\"".to_owned())];
        list.extend(other.library());
        list.push(("language", other.language()));
        let text = format!("Table({})", fields(&list));
        let numbers = |callable: &Callable| callable.parameters.iter().all(|(_, ty)| *ty == Type::Number);
        let known = other.scope.callable.iter().filter(|callable| callable.by_name && numbers(callable));
        let called: Vec<Callable> = known
            .map(|callable| Callable { name: format!("im.{}", callable.name), by_name: false, ..callable.clone() })
            .collect();
        self.scope.callable.extend(called);
        ("{\"im\": \"other.ron\"}".to_owned(), ("other.ron".to_owned(), text))
    }
}
