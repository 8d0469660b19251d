//! The contract of `umbrage eval`.

use crate::support::{Place, Said};

fn smsr() -> Place {
    let place = Place::new();
    place.table("smsr.ron");
    place
}

fn rsmss() -> Place {
    let place = Place::new();
    place.table("rsmss.ron");
    place
}

const HEADER: &str = "H,V,tH,tV,dH,dV,px,py,domH,domV";
const PLAIN: &str = "H,V,b,tH,tV,dH,dV,px,py,domH,domV";

fn answers(said: &Said) -> Vec<&str> {
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""), "{}", said.all());
    said.out.lines().collect()
}

#[test]
fn columns_in_any_order_and_levels_by_name_or_value() {
    let place = smsr();
    let by_name = format!(
        "{HEADER}\nnone,bottom,positive_negative,positive_negative,0.75,0,0.5,0.875,false,false\n\
         none,top,dual_negative,positive_negative,0,0,0.5,0.5,false,true\n"
    );
    let by_value =
        "py, domV ,domH,V,H,tV,tH,dV,dH,px\n0.875,0,0,0.50,0,0,0,0,0.75,0.5\n5e-1,1,0,0.25,0.0,0,-1,0,0,0.5\n";
    let said = place.run_with("eval smsr.ron", &by_name);
    assert_eq!(answers(&said), ["case,value", "9,0", "1,1"]);
    assert_eq!(place.run_with("eval smsr.ron --input -", by_value).out, said.out);
}

#[test]
fn files_and_streams_say_the_same() {
    let place = smsr();
    let rows = format!("{HEADER}\r\nleft,none,0,0,0,0.75,0.125,0.5,false,false\r\n");
    place.file("rows.csv", &rows).file("out.csv", "old");
    assert_eq!(answers(&place.run("eval smsr.ron --input rows.csv --output out.csv")), [""; 0]);
    assert_eq!(place.read("out.csv"), "case,value\n11,0\n");
    assert_eq!(place.run("eval smsr.ron --input rows.csv --output -").out, "case,value\n11,0\n");
    assert_eq!(place.run_with("eval smsr.ron --output new.csv", &rows).code, Some(0));
    assert_eq!(place.read("new.csv"), "case,value\n11,0\n");
    assert_eq!(place.files(), ["new.csv", "out.csv", "rows.csv", "smsr.ron"]);
}

#[test]
fn no_case_is_the_default() {
    let rows = format!("{HEADER}\nnone,none,0,0,0,0,0.5,0.5,false,false\n");
    assert_eq!(answers(&smsr().run_with("eval smsr.ron", &rows)), ["case,value", "default,1"]);
}

#[test]
fn a_header_alone_has_no_answers() {
    let place = smsr();
    for header in [format!("{HEADER}\n"), HEADER.to_owned()] {
        assert_eq!(answers(&place.run_with("eval smsr.ron", &header)), ["case,value"]);
    }
    place.file("rows.json", "[]");
    assert_eq!(answers(&place.run("eval smsr.ron --input rows.json")), ["case,value"]);
    assert_eq!(place.run("eval smsr.ron --input rows.json --output out.json").code, Some(0));
    assert_eq!(place.read("out.json"), "[]\n");
}

#[test]
fn fetched_inputs_may_be_absent_where_they_are_not_needed() {
    let place = rsmss();
    // Case 23 needs none; case 13 needs `d_cb_h`.
    let rows = format!("{PLAIN}\nleft,none,entering,0,0,0,0.75,0.25,0.5,false,false\n");
    assert_eq!(answers(&place.run_with("eval rsmss.ron", &rows)), ["case,value", "23,0.5"]);
    let rows = format!(
        "{PLAIN},d_cb_h\nleft,none,0,0,0,0,0.75,0.25,0.5,false,false,\nboth,none,1,0,0,0,0.75,0.25,0.5,false,false,left\n"
    );
    assert_eq!(answers(&place.run_with("eval rsmss.ron", &rows)), ["case,value", "23,0.5", "13,0.5"]);
    let rows = format!("{PLAIN}\nleft,none,0,0,0,0,0.75,0.25,0.5,0,0\nboth,none,1,0,0,0,0.75,0.25,0.5,0,0\n");
    let said = place.run_with("eval rsmss.ron", &rows);
    assert_eq!((said.code, said.out.as_str()), (Some(2), ""));
    assert!(said.err.starts_with("error[U0703]: line 3: case 13 needs `d_cb_h`, which is absent\n"), "{}", said.err);
}

#[test]
fn json_in_and_out() {
    let place = rsmss();
    place.file(
        "rows.json",
        r#"[{"V": "none", "H": 0.5, "b": 0, "tH": 0, "tV": "positive_negative", "dH": 0, "dV": 0.7,
             "px": 0.25, "py": 0.5, "domH": false, "domV": 0, "n_top": null},
            {"H": "both", "V": "both", "b": "exiting", "tH": 0, "tV": 0, "dH": 0, "dV": 0,
             "px": 0, "py": 0, "domH": false, "domV": true}]"#,
    );
    assert_eq!(place.run("eval rsmss.ron --input rows.json --output out.json").code, Some(0));
    assert_eq!(place.read("out.json"), "[\n{\"case\":23,\"value\":0.55},\n{\"case\":3,\"value\":1}\n]\n");
    assert_eq!(place.run("eval rsmss.ron --input rows.json --output out.csv --precision f64").code, Some(0));
    assert_eq!(place.read("out.csv"), "case,value\n23,0.55\n3,1\n");
    let rows = place.read("rows.json");
    assert_eq!(answers(&place.run_with("eval rsmss.ron", &rows)), ["case,value", "23,0.55", "3,1"]);
}

#[test]
fn numbers_read_back_exactly() {
    let place = Place::new();
    place.file(
        "t.ron",
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {"x": Range(from: -1000000, to: 1000000)},
            output: Number(), cases: [Case(id: 1, when: "x < 0", value: "exp(x)")], default: "x / 3")"#,
    );
    let inputs = [0.1, 1e-30, 12345.678, 999999.9, 1.0 / 3.0, -0.1, -80.0, -3.5];
    let rows: String = inputs.iter().map(|x: &f64| format!("{x}\n")).collect();
    let said = place.run_with("eval t.ron", &format!("x\n{rows}"));
    for (line, x) in answers(&said)[1..].iter().zip(inputs) {
        let x = x as f32;
        let expected = if x < 0.0 { f64::from(x).exp() as f32 } else { x / 3.0 };
        let read: f32 = line.split(',').nth(1).unwrap().parse().unwrap();
        assert_eq!(read.to_bits(), expected.to_bits(), "{line}");
    }
    let said = place.run_with("eval t.ron --precision f64", &format!("x\n{rows}"));
    for (line, x) in answers(&said)[1..].iter().zip(inputs).filter(|(_, x)| *x >= 0.0) {
        let read: f64 = line.split(',').nth(1).unwrap().parse().unwrap();
        assert_eq!(read.to_bits(), (x / 3.0).to_bits(), "{line}");
    }
}

#[test]
fn outputs_of_every_kind() {
    let place = Place::new();
    let table = |output: &str, value: &str, default: &str| {
        format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                levels: {{"way": {{"north": 0, "east": 1, "south": 2}}}},
                inputs: {{"w": Levels(of: "way"), "x": Range(from: 0, to: 1)}},
                output: {output}, cases: [Case(id: 7, when: "x > 0.5", value: "{value}")], default: "{default}")"#
        )
    };
    let rows = "w,x\neast,0.75\nsouth,0.25\n";
    place.file("t.ron", table("Vector(size: 3)", "vec3(x, 1 - x, log(0 * x))", "vec3(0)"));
    let said = place.run_with("eval t.ron", rows);
    assert_eq!(answers(&said), ["case,value_x,value_y,value_z", "7,0.75,0.25,-inf", "default,0,0,0"]);
    assert_eq!(place.run_with("eval t.ron --output out.json", rows).code, Some(0));
    let json = "[\n{\"case\":7,\"value\":[0.75,0.25,\"-inf\"]},\n{\"case\":\"default\",\"value\":[0,0,0]}\n]\n";
    assert_eq!(place.read("out.json"), json);

    place.file("t.ron", table("Enumeration(of: \"way\")", "w", "north"));
    assert_eq!(answers(&place.run_with("eval t.ron", rows)), ["case,value", "7,east", "default,north"]);

    place.file("t.ron", table("List(of: \"way\", max: 3)", "[w, north]", "[]"));
    assert_eq!(answers(&place.run_with("eval t.ron", rows)), ["case,value", "7,east north", "default,"]);
    assert_eq!(place.run_with("eval t.ron --output out.json", rows).code, Some(0));
    let json = "[\n{\"case\":7,\"value\":[\"east\",\"north\"]},\n{\"case\":\"default\",\"value\":[]}\n]\n";
    assert_eq!(place.read("out.json"), json);
}

#[test]
fn a_hundred_thousand_rows_keep_their_order() {
    let place = smsr();
    let count = 100_000;
    let mut rows = format!("{HEADER}\n");
    for i in 0..count {
        // Case 9 closes where 1 - py < dH.
        let dh = (i % 1000) as f32 / 1000.0;
        rows.push_str(&format!("none,bottom,0,0,{dh},0,0.5,0.5,false,false\n"));
    }
    place.file("rows.csv", rows);
    assert_eq!(place.run("eval smsr.ron --input rows.csv --output out.csv").code, Some(0));
    let out = place.read("out.csv");
    let lines: Vec<&str> = out.lines().skip(1).collect();
    assert_eq!(lines.len(), count);
    for (i, line) in lines.iter().enumerate() {
        assert_eq!(*line, if i % 1000 > 500 { "9,0" } else { "9,1" }, "row {i}");
    }
}

#[test]
fn quoted_cells_and_a_byte_order_mark() {
    let place = Place::new();
    place.file(
        "t.ron",
        r#"Table(language: 1, name: "t", hit_policy: First, inputs: {"s": Bool(), "x": Range(from: 0, to: 1)},
        output: Number(), cases: [Case(id: 1, when: "s", value: "x")], default: 0)"#,
    );
    let said = place.run_with("eval t.ron", "\u{feff}\"x\",s\r\n\"0.5\",\"true\"\r\n\r\n 0.25 , 1\r\n");
    assert_eq!(answers(&said), ["case,value", "1,0.5", "1,0.25"]);
}

#[test]
fn a_plan_is_for_the_gpu() {
    let rows = format!("{HEADER}\nnone,none,0,0,0,0,0.5,0.5,false,false\n");
    let said = smsr().run_with("eval smsr.ron --plan switch", &rows);
    assert_eq!((said.code, said.out.as_str()), (Some(0), "case,value\ndefault,1\n"));
    assert!(said.err.starts_with("note[U0602]: the interpreter follows the table itself"), "{}", said.err);
}

/// Whoever reads our output may stop: `umbrage explain … | head -1`.
#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_error() {
    use std::process::{Command, Stdio};
    let place = smsr();
    let mut child = Command::new(env!("CARGO_BIN_EXE_umbrage"))
        .args(["explain", "smsr.ron"])
        .current_dir(place.path("."))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), &b""[..]));
}

/// A device is written to, not replaced by a file.
#[cfg(unix)]
#[test]
fn devices_stay_devices() {
    use std::os::unix::fs::FileTypeExt;
    let place = smsr();
    place.file("rows.csv", format!("{HEADER}\n"));
    assert_eq!(place.run("eval smsr.ron --input rows.csv --output /dev/null").code, Some(0));
    assert!(std::fs::metadata("/dev/null").unwrap().file_type().is_char_device());
}

/// A replaced file keeps its permissions, a link keeps leading to it.
#[cfg(unix)]
#[test]
fn permissions_and_links_stay() {
    use std::os::unix::fs::PermissionsExt;
    let place = smsr();
    place.file("rows.csv", format!("{HEADER}\n")).file("out.csv", "old");
    std::fs::set_permissions(place.path("out.csv"), std::fs::Permissions::from_mode(0o640)).unwrap();
    std::os::unix::fs::symlink("out.csv", place.path("link.csv")).unwrap();
    assert_eq!(place.run("eval smsr.ron --input rows.csv --output link.csv").code, Some(0));
    assert_eq!(place.read("out.csv"), "case,value\n");
    assert!(std::fs::symlink_metadata(place.path("link.csv")).unwrap().is_symlink());
    assert_eq!(std::fs::metadata(place.path("out.csv")).unwrap().permissions().mode() & 0o777, 0o640);
    assert_eq!(place.run("eval smsr.ron --input rows.csv --output new.csv").code, Some(0));
    assert_ne!(std::fs::metadata(place.path("new.csv")).unwrap().permissions().mode() & 0o777, 0o600);
}

#[test]
fn words_are_read_and_written_to_the_last_bit() {
    let place = Place::new();
    place.table("pcg.ron");
    let rows = "v\n0\n0x1\n12345\n4294967295\n";
    let said = place.run_with("eval pcg.ron --function hash", rows);
    assert_eq!(answers(&said), ["case,value", "0,129708002", "0,2831084092", "0,4099845390", "0,3861530882"]);
    assert_eq!(place.run_with("eval pcg.ron --function hash --precision f64", rows).out, said.out);
    place.file("rows.json", r#"[{"v": 0}, {"v": 4294967295}]"#);
    let said = place.run("eval pcg.ron --function hash --input rows.json --output out.json");
    assert_eq!(answers(&said), [""; 0]);
    assert_eq!(place.read("out.json"), "[\n{\"case\":0,\"value\":129708002},\n{\"case\":0,\"value\":3861530882}\n]\n");
    for (value, row) in [("4294967296", 2), ("-1", 2), ("0.5", 2), ("0x100000000", 2), ("one", 2)] {
        let said = place.run_with("eval pcg.ron --function hash", &format!("v\n{value}\n"));
        let expected = format!("`{value}` is no value of `v`, which is a whole number from 0 to 4294967295");
        assert!(said.code == Some(2) && said.err.contains(&expected), "{}", said.all());
        assert!(said.err.contains(&format!("standard input:{row}:1")), "{}", said.all());
    }
    let said = place.run("explain pcg.ron --function hash --at v=0xffffffff");
    assert!(said.out.contains("v = 4294967295") && said.out.contains("result:  3861530882"), "{}", said.all());
}
