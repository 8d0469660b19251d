//! `umbrage lsp`, talked to as an editor does.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use serde_json::{Value, json};

use super::support::{Place, umbrage};

/// Time in which an answer comes, on a slow machine that does much else.
const PATIENCE: Duration = Duration::from_secs(120);

/// An editor.
struct Editor {
    child: Child,
    input: Option<ChildStdin>,
    messages: Receiver<Value>,
    /// What came while something else was waited for.
    kept: Vec<Value>,
    requests: i64,
}

impl Editor {
    /// Starts the server, and introduces itself with some parameters beside the usual ones.
    fn start(place: &Place, more: Value) -> Self {
        let mut editor = Self::mute(place);
        let mut params = json!({
            "processId": null, "rootUri": null,
            "capabilities": {"textDocument": {"completion": {"completionItem": {"snippetSupport": true}}}},
        });
        if let (Some(params), Some(more)) = (params.as_object_mut(), more.as_object()) {
            params.extend(more.clone());
        }
        let said = editor.ask("initialize", params);
        assert_eq!(said["serverInfo"]["name"], "umbrage");
        editor.tell("initialized", json!({}));
        editor
    }

    /// Starts the server and says nothing.
    fn mute(place: &Place) -> Self {
        let mut child = umbrage()
            .arg("lsp")
            .current_dir(place.path(""))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (send, messages) = channel();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        std::thread::spawn(move || {
            while let Some(message) = received(&mut output) {
                if send.send(message).is_err() {
                    break;
                }
            }
        });
        let input = child.stdin.take();
        Self { child, input, messages, kept: Vec::new(), requests: 0 }
    }

    fn write(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().unwrap();
        input.write_all(bytes).and_then(|()| input.flush()).unwrap();
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        self.write(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
    }

    fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({"jsonrpc": "2.0", "method": method, "params": params}));
    }

    /// The whole answer to a request.
    fn answer(&mut self, method: &str, params: Value) -> Value {
        self.requests += 1;
        let id = self.requests;
        self.send(&json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}));
        self.wait(|message| message["id"] == id)
    }

    /// The result of a request.
    fn ask(&mut self, method: &str, params: Value) -> Value {
        let answer = self.answer(method, params);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// The first message, received or to come, that is wanted.
    fn wait(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        if let Some(at) = self.kept.iter().position(&wanted) {
            return self.kept.remove(at);
        }
        loop {
            match self.messages.recv_timeout(PATIENCE) {
                Ok(message) if wanted(&message) => return message,
                Ok(message) => self.kept.push(message),
                Err(RecvTimeoutError::Timeout) => panic!("no answer; there were {:?}", self.kept),
                Err(RecvTimeoutError::Disconnected) => panic!("the server has gone; there were {:?}", self.kept),
            }
        }
    }

    /// Opens a text and returns what is found in it.
    fn open(&mut self, uri: &str, text: &str) -> Vec<Value> {
        let document = json!({"uri": uri, "languageId": "ron", "version": 1, "text": text});
        self.tell("textDocument/didOpen", json!({"textDocument": document}));
        self.found(uri, 1)
    }

    /// Replaces a text and returns what is found in it.
    fn replace(&mut self, uri: &str, version: i64, text: &str) -> Vec<Value> {
        let params = json!({"textDocument": {"uri": uri, "version": version}, "contentChanges": [{"text": text}]});
        self.tell("textDocument/didChange", params);
        self.found(uri, version)
    }

    fn found(&mut self, uri: &str, version: i64) -> Vec<Value> {
        let message = self.wait(|message| {
            message["method"] == "textDocument/publishDiagnostics"
                && message["params"]["uri"] == uri
                && message["params"]["version"] == version
        });
        message["params"]["diagnostics"].as_array().unwrap().clone()
    }

    /// Asks about the place of a mark, `@`, in a text that is open without it.
    fn ask_at(&mut self, method: &str, uri: &str, marked: &str) -> Value {
        self.ask(method, json!({"textDocument": {"uri": uri}, "position": position(marked)}))
    }

    /// The labels that are offered at a mark, after the text was replaced by that without it.
    fn offered(&mut self, uri: &str, version: i64, marked: &str) -> Vec<String> {
        self.replace(uri, version, &marked.replace('@', ""));
        let items = self.ask_at("textDocument/completion", uri, marked);
        items.as_array().unwrap().iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    }

    /// Says goodbye; the exit code, and what was said on standard error.
    fn end(mut self) -> (Option<i32>, String) {
        self.ask("shutdown", Value::Null);
        self.tell("exit", Value::Null);
        self.gone()
    }

    /// Goes away.
    fn gone(mut self) -> (Option<i32>, String) {
        drop(self.input.take());
        let status = self.child.wait().unwrap();
        let mut said = String::new();
        self.child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        (status.code(), said)
    }
}

fn received(output: &mut impl BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if output.read_line(&mut line).ok()? == 0 {
            return None;
        }
        match line.trim() {
            "" => break,
            line => length = line.strip_prefix("Content-Length: ")?.parse().ok()?,
        }
    }
    let mut bytes = vec![0; length];
    output.read_exact(&mut bytes).ok()?;
    serde_json::from_slice(&bytes).ok()
}

/// The position of the mark in a text: the tables here are of ASCII, but for what says so.
fn position(marked: &str) -> Value {
    let before = marked.split('@').next().unwrap();
    let line = before.matches('\n').count();
    let column: usize = before.rsplit('\n').next().unwrap().chars().map(char::len_utf16).sum();
    json!({"line": line, "character": column})
}

/// The text that a range of a text holds.
fn piece<'t>(text: &'t str, range: &Value) -> &'t str {
    let offset = |position: &Value| {
        let line = position["line"].as_u64().unwrap() as usize;
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let mut column = position["character"].as_u64().unwrap() as usize;
        let mut at = start;
        let mut rest = text[start..].chars();
        while column > 0 {
            let c = rest.next().unwrap();
            column -= c.len_utf16();
            at += c.len_utf8();
        }
        at
    };
    &text[offset(&range["start"])..offset(&range["end"])]
}

/// A text after the edits of a workspace edit to its only file.
fn edited(text: &str, edit: &Value) -> String {
    let changes = edit["changes"].as_object().unwrap();
    assert_eq!(changes.len(), 1, "{edit}");
    let edits = changes.values().next().unwrap().as_array().unwrap();
    with(text, edits)
}

fn with(text: &str, edits: &[Value]) -> String {
    let mut out = text.to_owned();
    for edit in edits.iter().rev() {
        let old = piece(text, &edit["range"]);
        let start = old.as_ptr() as usize - text.as_ptr() as usize;
        out.replace_range(start..start + old.len(), edit["newText"].as_str().unwrap());
    }
    out
}

fn uri(place: &Place, name: &str) -> String {
    format!("file://{}", place.path(name).display())
}

const TABLE: &str = r#"Table(
    language: 2,
    name: "snow",
    hit_policy: First,
    levels: {"wind": {"calm": 0, "storm": 1}},
    inputs: {
        "wind_now": Levels(of: "wind", default: calm, doc: "the wind"),
        "roof": Levels(values: {"thatch": 0, "slate": 1}, default: slate),
        "x": Range(from: 0, to: 1, default: 0.5),
    },
    names: {"quiet": "wind_now == calm", "edge": "min(x, 1 - x)"},
    output: Number(),
    cases: [
        Case(id: 1, doc: "deep", when: "quiet && roof == thatch", value: "edge", examples: [({"roof": "thatch"}, 0.5)]),
        Case(id: 2, doc: "half of it", when: {"roof": "slate"}, value: "0.5 * case(1)"),
        Case(id: 3, when: "!quiet && roof == thatch", value: 0.25),
    ],
    default: 0,
)
"#;

#[test]
fn findings_come_as_one_types_and_their_repairs_mend_them() {
    let place = Place::new();
    let mut editor = Editor::start(&place, json!({}));
    let uri = uri(&place, "snow.ron");
    assert_eq!(editor.open(&uri, TABLE), Vec::<Value>::new());
    // A misspelt level, with its code, its place, and the repair.
    let wrong = TABLE.replacen("roof == thatch", "roof == thach", 1);
    let found = editor.replace(&uri, 2, &wrong);
    let [finding] = found.as_slice() else { panic!("{found:?}") };
    assert_eq!(
        (&finding["code"], &finding["severity"], &finding["source"]),
        (&json!("U0204"), &json!(1), &json!("umbrage"))
    );
    assert_eq!(piece(&wrong, &finding["range"]), "thach");
    assert_eq!(
        finding["message"],
        "there is no level `thach`: not one of the levels here\ndid you mean `thatch`?\nthe levels are: thatch (0), slate (1)"
    );
    let actions = |editor: &mut Editor, range: &Value| {
        let params = json!({"textDocument": {"uri": uri}, "range": range, "context": {"diagnostics": []}});
        editor.ask("textDocument/codeAction", params).as_array().unwrap().clone()
    };
    let offered = actions(&mut editor, &finding["range"]);
    assert_eq!(offered[0]["title"], "write `thatch`");
    assert_eq!(edited(&wrong, &offered[0]["edit"]), TABLE);
    // An edit of a part: the mark of a finding, and the `allow` that acknowledges it.
    let mended = json!({
        "textDocument": {"uri": uri, "version": 3},
        "contentChanges": [
            {"range": finding["range"], "text": "thatch"},
            {"range": {"start": {"line": 10, "character": 4}, "end": {"line": 10, "character": 4}}, "text": "symmetries: {},\n    "},
        ],
    });
    editor.tell("textDocument/didChange", mended);
    assert_eq!(editor.found(&uri, 3), Vec::<Value>::new());
    let crossing = TABLE.replace("value: \"edge\"", "lines: [(0.25, \"x < 0.5\"), (\"x\", \"x > 0.25\"), 0]");
    let found = editor.replace(&uri, 4, &crossing);
    let finding = found.iter().find(|finding| finding["code"] == "U0508").unwrap_or_else(|| panic!("{found:?}"));
    let offered = actions(&mut editor, &finding["range"]);
    let allow = offered.iter().find(|action| action["title"] == "acknowledge it in case 1, with a reason").unwrap();
    let acknowledged = edited(&crossing, &allow["edit"]);
    assert!(
        acknowledged.contains("], allow: [(code: \"U0508\", with: [\"lines 1 and 2\"], reason: \"...\")])"),
        "{acknowledged}"
    );
    let left = editor.replace(&uri, 5, &acknowledged);
    assert!(left.iter().all(|finding| finding["code"] != "U0508"), "{left:?}");
    // What acknowledges nothing is taken out again.
    let needless = TABLE.replace("value: \"edge\"", "value: \"edge\", allow: [(code: \"U0508\", reason: \"none\")]");
    let found = editor.replace(&uri, 6, &needless);
    let finding = found.iter().find(|finding| finding["code"] == "U0531").unwrap_or_else(|| panic!("{found:?}"));
    assert_eq!(finding["tags"], json!([1]));
    let offered = actions(&mut editor, &finding["range"]);
    let removed = edited(&needless, &offered[0]["edit"]);
    assert!(!removed.contains("allow"), "{removed}");
    assert_eq!(editor.replace(&uri, 7, &removed), Vec::<Value>::new());
    // Fields and the version of the language know their repairs, too.
    for (version, wrong, right, title) in [
        (8, TABLE.replace("hit_policy:", "hit_polic:"), TABLE.to_owned(), "write `hit_policy`"),
        (
            10,
            TABLE
                .replace("language: 2", "language: 1")
                .replace("    names:", "    groups: {\"g\": [\"x\"]},\n    names:"),
            TABLE.replace("    names:", "    groups: {\"g\": [\"x\"]},\n    names:"),
            "write `language: 2`",
        ),
    ] {
        let found = editor.replace(&uri, version, &wrong);
        let offered = actions(&mut editor, &found[0]["range"]);
        assert_eq!(offered[0]["title"], title, "{found:?}");
        assert_eq!(edited(&wrong, &offered[0]["edit"]), right);
    }
    // A text that is closed has no findings.
    editor.tell("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
    let closed =
        editor.wait(|m| m["method"] == "textDocument/publishDiagnostics" && m["params"].get("version").is_none());
    assert_eq!(closed["params"]["diagnostics"], json!([]));
    assert_eq!(editor.end(), (Some(0), String::new()));
}

#[test]
fn a_word_says_what_it_is() {
    let place = Place::new();
    std::fs::create_dir(place.path("profiles")).unwrap();
    let profile = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/profiles/smsr.ron")).unwrap();
    place.file("profiles/smsr.ron", profile).table("smsr.ron");
    let smsr = place.read("smsr.ron");
    let mut editor = Editor::start(&place, json!({"initializationOptions": {"pictures": true}}));
    let uri = uri(&place, "smsr.ron");
    editor.open(&uri, &smsr);
    let mut hover = |at: &str| {
        let marked = smsr.replacen(&at.replace('@', ""), at, 1);
        assert!(marked.contains('@'), "{at}");
        let said = editor.ask_at("textDocument/hover", &uri, &marked);
        said["contents"]["value"].as_str().unwrap_or_default().to_owned()
    };
    let case = hover("case(1@1, V = none)");
    assert!(case.starts_with("**case 11**\n\n"), "{case}");
    assert!(case.contains("when  ") && case.contains("% of `profiles/smsr.ron`: fence "), "{case}");
    assert!(case.contains("![case 11](data:image/png;base64,"), "{case}");
    let name = hover("corner && d@omH && !domV");
    assert!(name.starts_with("**domH**, an input\n\nthe horizontal discontinuity dominates"), "{name}");
    let level = hover("if H == le@ft { px }");
    assert_eq!(level, "**left**, a level of `H`\n\nLevels of `H`: `none`, `right`, **`left`**, `both`");
    let input = hover("\"t@H\":   Levels(of");
    assert!(input.contains("Levels of `run`: `dual_negative`, `positive_negative`, `dual_positive`"), "{input}");
    assert!(hover("allow: [(code: \"U05@09\"").starts_with("**U0509**: cases that can match together"));
    assert_eq!(hover("value: \"mi@n(if V == bottom"), "`min(a, b)`: the smaller");
    assert_eq!(hover("hit_pol@icy"), "`hit_policy`: [`First`, `Unique` or `Collect`](#hit-policy)");
    let example = hover("examples: [(@{\"H\": \"both\", \"px\": 0.5}, 0)]");
    assert!(example.starts_with("```text\nsmsr: Shadow map") && example.contains("case 3"), "{example}");
    assert_eq!(hover("// SMSR@: the 12"), "");
    editor.end();
}

#[test]
fn words_lead_to_declarations_and_back() {
    let place = Place::new();
    let sets = "Table(language: 2, name: \"sets\", levels: {\"wind\": {\"calm\": 0, \"storm\": 1}}, constants: {\"halved\": 0.5})";
    place.file("sets.ron", sets);
    let text = TABLE
        .replace("levels: {\"wind\": {\"calm\": 0, \"storm\": 1}},", "imports: {\"s\": \"sets.ron\"},")
        .replace("of: \"wind\"", "of: \"s::wind\"")
        .replace("0.5 * case(1)", "s.halved * case(1)");
    let mut editor = Editor::start(&place, json!({}));
    let uri = uri(&place, "snow.ron");
    assert_eq!(editor.open(&uri, &text), Vec::<Value>::new());
    let definition = |editor: &mut Editor, at: &str| {
        let marked = text.replacen(&at.replace('@', ""), at, 1);
        let said = editor.ask_at("textDocument/definition", &uri, &marked);
        let [location] = said.as_array().unwrap().as_slice() else { panic!("{at}: {said}") };
        let file = location["uri"].as_str().unwrap().rsplit('/').next().unwrap().to_owned();
        let whole = if file == "snow.ron" { text.as_str() } else { sets };
        (file, piece(whole, &location["range"]).to_owned(), location["range"]["start"]["line"].as_u64().unwrap())
    };
    let own = |word: &str, line: u64| ("snow.ron".to_owned(), word.to_owned(), line);
    assert_eq!(definition(&mut editor, "when: \"qui@et"), own("quiet", 10));
    assert_eq!(definition(&mut editor, "roof == that@ch"), own("thatch", 7));
    assert_eq!(definition(&mut editor, "case(@1)"), own("1", 13));
    assert_eq!(definition(&mut editor, "{\"ro@of\": \"slate\"}"), own("roof", 7));
    assert_eq!(definition(&mut editor, "wind_now == cal@m"), ("sets.ron".to_owned(), "calm".to_owned(), 0));
    assert_eq!(definition(&mut editor, "s.halv@ed"), ("sets.ron".to_owned(), "halved".to_owned(), 0));
    assert_eq!(definition(&mut editor, "\"@s.halved"), ("sets.ron".to_owned(), String::new(), 0));
    // A table with a mistake: what was declared before is found where it stands now.
    let broken = format!("\n{}", text.replace("default: 0,", "default: ,"));
    editor.replace(&uri, 2, &broken);
    let marked = broken.replacen("when: \"quiet", "when: \"qui@et", 1);
    let said = editor.ask_at("textDocument/definition", &uri, &marked);
    assert_eq!(said[0]["range"]["start"]["line"], 11);
    editor.replace(&uri, 3, &text);
    // References, with and without the declaration.
    let references = |editor: &mut Editor, at: &str, declaration: bool| {
        let marked = text.replacen(&at.replace('@', ""), at, 1);
        let context = json!({"includeDeclaration": declaration});
        let params = json!({"textDocument": {"uri": uri}, "position": position(&marked), "context": context});
        let said = editor.ask("textDocument/references", params);
        said.as_array().unwrap().iter().map(|l| l["range"]["start"]["line"].as_u64().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(references(&mut editor, "\"x@\": Range", true), [8, 10, 10]);
    assert_eq!(references(&mut editor, "\"x@\": Range", false), [10, 10]);
    assert_eq!(references(&mut editor, "\"that@ch\": 0", true), [7, 13, 13, 15]);
    assert_eq!(references(&mut editor, "id: @1", true), [13, 14]);
    let outline = editor.ask("textDocument/documentSymbol", json!({"textDocument": {"uri": uri}}));
    let names: Vec<&str> = outline.as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["s", "wind_now", "roof", "x", "quiet", "edge", "case 1", "case 2", "case 3"]);
    editor.end();
}

#[test]
fn names_are_changed_everywhere_or_not_at_all() {
    let place = Place::new();
    let mut editor = Editor::start(&place, json!({}));
    let uri = uri(&place, "snow.ron");
    editor.open(&uri, TABLE);
    let rename = |editor: &mut Editor, at: &str, name: &str| {
        let marked = TABLE.replacen(&at.replace('@', ""), at, 1);
        let params = json!({"textDocument": {"uri": uri}, "position": position(&marked), "newName": name});
        let answer = editor.answer("textDocument/rename", params);
        match answer.get("error") {
            Some(error) => Err(error["message"].as_str().unwrap().to_owned()),
            None => Ok(edited(TABLE, &answer["result"])),
        }
    };
    let all = |from: &str, to: &str| Ok(TABLE.replace(from, to));
    assert_eq!(rename(&mut editor, "\"qui@et\":", "still"), all("quiet", "still"));
    assert_eq!(rename(&mut editor, "roof == that@ch", "straw"), all("thatch", "straw"));
    assert_eq!(rename(&mut editor, "\"wind@\": {", "air"), Ok(TABLE.replace("\"wind\"", "\"air\"")));
    assert_eq!(
        rename(&mut editor, "case(@1)", "7"),
        Ok(TABLE.replace("id: 1,", "id: 7,").replace("case(1)", "case(7)"))
    );
    // Names that are taken, reserved or none.
    let taken = "with `roof` this would be no table: the name `roof` is taken (line 11)";
    assert_eq!(rename(&mut editor, "\"qui@et\":", "roof"), Err(taken.to_owned()));
    assert!(rename(&mut editor, "\"qui@et\":", "fn").unwrap_err().contains("`fn` is a reserved word"));
    assert!(rename(&mut editor, "\"qui@et\":", "a\", \"b").is_err());
    assert_eq!(
        rename(&mut editor, "default: 0@,", "q"),
        Err("nothing that is declared in the table stands here".to_owned())
    );
    let marked = TABLE.replacen("\"edge\": \"min", "\"ed@ge\": \"min", 1);
    let prepared = editor.ask_at("textDocument/prepareRename", &uri, &marked);
    assert_eq!((piece(TABLE, &prepared["range"]), &prepared["placeholder"]), ("edge", &json!("edge")));
    // Of a table with mistakes nobody could say that it stays the same.
    editor.replace(&uri, 2, &TABLE.replace("1 - x", "1 - y"));
    assert!(rename(&mut editor, "\"qui@et\":", "still").unwrap_err().starts_with("the table has mistakes"));
    editor.end();
}

#[test]
fn what_fits_is_offered() {
    let place = Place::new();
    let mut editor = Editor::start(&place, json!({}));
    let uri = uri(&place, "snow.ron");
    editor.open(&uri, TABLE);
    let mut version = 1;
    let mut offered = |marked: &str| {
        version += 1;
        editor.offered(&uri, version, marked)
    };
    let has = |all: &[String], some: &[&str]| some.iter().all(|word| all.iter().any(|label| label == word));
    // The text is no table at any of these places; the last one that was is remembered.
    let case = |inner: &str| TABLE.replace("    ],\n    default", &format!("        {inner}\n    ],\n    default"));
    assert_eq!(offered(&case("Case(id: 4, when: \"roof == @")).first().map(String::as_str), Some("thatch"));
    assert_eq!(offered(&case("Case(id: 4, when: \"roof in {slate, @")), ["thatch", "slate"]);
    assert_eq!(offered(&case("Case(id: 4, when: \"roof == wind::@")), ["calm", "storm"]);
    assert_eq!(offered(&case("Case(id: 4, when: {\"roof\": \"@")).first().map(String::as_str), Some("thatch"));
    assert!(has(&offered(&case("Case(id: 4, when: {\"@")), &["wind_now", "roof", "x", "quiet"]));
    assert_eq!(offered(&case("Case(id: 4, when: true, value: \"case(@")), ["1", "2", "3"]);
    let expression = offered(&case("Case(id: 4, when: true, value: \"let depth = x; ed@"));
    assert!(has(&expression, &["depth", "edge", "quiet", "x", "min", "smoothstep", "if"]), "{expression:?}");
    let fields = offered(&case("Case(id: 4, @"));
    assert!(has(&fields, &["when", "value", "lines", "is"]) && !has(&fields, &["id"]), "{fields:?}");
    assert!(has(&offered(&case("@")), &["Case"]));
    assert!(has(&offered(&TABLE.replace("    output", "    @\n    output")), &["symmetries", "assume"]));
    let outputs = offered(&TABLE.replace("output: Number()", "output: @"));
    assert!(has(&outputs, &["Number", "Vector", "Enumeration", "List", "Bool", "Int", "Record"]), "{outputs:?}");
    assert!(has(
        &offered(&TABLE.replace("    },\n    names", "        \"y\": @\n    },\n    names")),
        &["Levels", "Bool", "Int", "Range"]
    ));
    assert!(has(&offered(&TABLE.replace("of: \"wind\"", "of: \"@\"")), &["wind", "roof"]));
    assert_eq!(offered(&TABLE.replace("default: slate", "default: @")), ["thatch", "slate"]);
    assert!(has(&offered(&case("Case(id: 4, allow: [(code: \"@")), &["U0508"]));
    assert_eq!(offered(&case("Case(id: 4, doc: \"@")), [""; 0]);
    assert_eq!(offered(&case("// Case(@")), [""; 0]);
    // What is chosen takes the place of what was begun, in UTF-16 as the client counts, and goes on in the parentheses.
    let marked = case("Case(id: 4, doc: \"\u{1f328} snow\", when: \"mi@");
    editor.replace(&uri, 100, &marked.replace('@', ""));
    let items = editor.ask_at("textDocument/completion", &uri, &marked);
    let item = items.as_array().unwrap().iter().find(|item| item["label"] == "min").unwrap();
    assert_eq!(piece(&marked.replace('@', ""), &item["textEdit"]["range"]), "mi");
    assert_eq!((&item["textEdit"]["newText"], &item["insertTextFormat"]), (&json!("min($0)"), &json!(2)));
    assert_eq!(item["documentation"]["value"], "the smaller");
    editor.end();
}

#[test]
fn texts_are_laid_out() {
    let place = Place::new();
    let mut editor =
        Editor::start(&place, json!({"capabilities": {"general": {"positionEncodings": ["utf-8", "utf-16"]}}}));
    let uri = uri(&place, "snow.ron");
    let loose = TABLE.replace("min(x, 1 - x)", "min( x,1-x )").replace("the wind", "the wind \u{1f328}");
    editor.open(&uri, &loose);
    let params = json!({"textDocument": {"uri": uri}, "options": {"tabSize": 4, "insertSpaces": true}});
    let edits = editor.ask("textDocument/formatting", params.clone());
    let laid_out = with(&loose, edits.as_array().unwrap());
    place.file("snow.ron", &loose);
    assert_eq!(place.run("fmt snow.ron").code, Some(0));
    assert_eq!(laid_out, place.read("snow.ron"));
    editor.replace(&uri, 2, &laid_out);
    assert_eq!(editor.ask("textDocument/formatting", params.clone()), json!([]));
    editor.replace(&uri, 3, "Table(");
    let answer = editor.answer("textDocument/formatting", params);
    assert!(answer["error"]["message"].as_str().unwrap().starts_with("not formatted: malformed RON"), "{answer}");
    editor.end();
}

#[test]
fn options_are_read() {
    let place = Place::new();
    let options = json!({"initializationOptions": {"levels": {"U0505": "deny", "U0000": "warn", "U0503": "never"}}});
    let mut editor = Editor::start(&place, options);
    let complaint = editor.wait(|message| message["method"] == "window/showMessage");
    let complaint = complaint["params"]["message"].as_str().unwrap().to_owned();
    assert!(complaint.contains("there is no finding `U0000`") && complaint.contains("not `never`"), "{complaint}");
    let uri = uri(&place, "snow.ron");
    let unused = TABLE.replace("min(x, 1 - x)", "0.5");
    let found = editor.open(&uri, &unused);
    let finding = found.iter().find(|finding| finding["code"] == "U0505").unwrap_or_else(|| panic!("{found:?}"));
    assert_eq!(finding["severity"], 1);
    editor.end();
}

/// A mistake in an imported table is said where it is imported, and gone once it is mended and saved.
#[test]
fn imported_tables_are_read_from_their_files() {
    let place = Place::new();
    place.file("sets.ron", "Table(language: 2, name: \"sets\", levels: {\"wind\": {\"calm\": 0");
    let text = TABLE
        .replace("levels: {\"wind\": {\"calm\": 0, \"storm\": 1}},", "imports: {\"s\": \"sets.ron\"},")
        .replace("of: \"wind\"", "of: \"s::wind\"");
    let mut editor = Editor::start(&place, json!({}));
    let uri = uri(&place, "snow.ron");
    let found = editor.open(&uri, &text);
    assert_eq!(piece(&text, &found[0]["range"]), "\"sets.ron\"");
    assert!(found[0]["message"].as_str().unwrap().contains("sets.ron:1: malformed RON"), "{found:?}");
    place.file("sets.ron", "Table(language: 2, name: \"sets\", levels: {\"wind\": {\"calm\": 0, \"storm\": 1}})");
    editor.tell("textDocument/didSave", json!({"textDocument": {"uri": uri}}));
    assert_eq!(editor.found(&uri, 1), Vec::<Value>::new());
    editor.end();
}

#[test]
fn nonsense_is_answered_or_ends() {
    let place = Place::new();
    // What is no message is complained about, and the conversation goes on.
    let mut editor = Editor::start(&place, json!({}));
    editor.write(b"Content-Length: 5\r\n\r\nhello");
    let complaint = editor.wait(|message| message["method"] == "window/logMessage");
    assert!(complaint["params"]["message"].as_str().unwrap().starts_with("a message that is none: "));
    for (method, params, code, reason) in [
        (
            "textDocument/hover",
            json!({"textDocument": {"uri": "file:///none.ron"}, "position": {"line": 0, "character": 0}}),
            -32602,
            "`file:///none.ron` is not open",
        ),
        ("textDocument/hover", json!({"position": "here"}), -32602, "invalid type"),
        (
            "textDocument/hover",
            json!({"textDocument": {"uri": "::"}, "position": {"line": 0, "character": 0}}),
            -32602,
            "",
        ),
        ("textDocument/dance", json!({}), -32601, "`textDocument/dance` is not offered"),
        ("initialize", json!({"capabilities": {}}), -32600, "introduced already"),
    ] {
        let answer = editor.answer(method, params);
        assert_eq!(answer["error"]["code"], code, "{method}: {answer}");
        assert!(answer["error"]["message"].as_str().unwrap().contains(reason), "{answer}");
    }
    editor.tell("textDocument/didChange", json!({"contentChanges": 7}));
    editor.tell("$/whatever", json!({}));
    // Positions beyond the text, and ranges that run backwards.
    let uri = uri(&place, "snow.ron");
    editor.open(&uri, TABLE);
    let far = json!({"line": 4_000_000_000_u32, "character": 4_000_000_000_u32});
    let range = json!({"start": far, "end": {"line": 0, "character": 3}});
    editor.tell(
        "textDocument/didChange",
        json!({"textDocument": {"uri": uri, "version": 2}, "contentChanges": [{"range": range, "text": " "}]}),
    );
    assert_eq!(editor.found(&uri, 2), Vec::<Value>::new());
    for method in ["hover", "completion", "definition", "documentHighlight"] {
        editor.ask(&format!("textDocument/{method}"), json!({"textDocument": {"uri": uri}, "position": far}));
    }
    assert_eq!(editor.end(), (Some(0), String::new()));
    // Before it introduces itself, a client is told so.
    let mut editor = Editor::mute(&place);
    let answer = editor.answer("textDocument/hover", json!({}));
    assert_eq!(answer["error"]["code"], -32002);
    // Clients that go away: in the middle of a message, without a word, without `shutdown`.
    editor.write(b"Content-Length: 1000\r\n\r\n{");
    assert_eq!(editor.gone(), (Some(1), String::new()));
    assert_eq!(Editor::start(&place, json!({})).gone(), (Some(1), String::new()));
    let mut editor = Editor::start(&place, json!({}));
    editor.tell("exit", Value::Null);
    assert_eq!(editor.gone(), (Some(1), String::new()));
    // What is not this protocol, or promises more than a table can have.
    for (bytes, reason) in [
        (&b"GET / HTTP/1.1\r\n\r\n"[..], "`GET / HTTP/1.1` is no header"),
        (b"Content-Length: 99999999999\r\n\r\n", "a message of 99999999999 bytes"),
        (b"Content-Length: -1\r\n\r\n", "gives no length"),
        (b"Content-Type: x\r\n\r\n", "a header without Content-Length"),
    ] {
        let mut editor = Editor::mute(&place);
        editor.write(bytes);
        let (code, said) = editor.gone();
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains("U0001") && said.contains(reason) && said.contains("docs/editors.md"), "{said}");
    }
}
