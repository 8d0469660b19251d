//! `umbrage light`, and the technique `integrals` in the commands that take any technique.

use crate::support::Place;

const STUDIO: &str = "--scene studio --size 16x9 --backend cpu";

/// `light` is short for `render`: the same pictures.
#[test]
fn light_is_short_for_render() {
    let place = Place::new();
    let said =
        place.run(&format!("light {STUDIO} -o short.png --reference truth.png --cells cells.png --threshold 0.3"));
    assert_eq!(said.code, Some(0), "{}", said.err);
    for part in
        ["prepared in ", "16 x 9 pixels in ", ", CPU, threshold 0.3", " cells, ", "brute force with 32768 directions"]
    {
        assert!(said.out.contains(part), "{part}: {}", said.out);
    }
    let long = [
        ("short.png", "--technique integrals --set border_threshold=0.3 --set lobe_threshold=0.3"),
        ("truth.png", "--technique brute_force"),
    ];
    for (short, technique) in long {
        let said = place.run(&format!("render {STUDIO} {technique} -o long.png"));
        assert_eq!(said.all(), "exit code: 0\n", "{technique}");
        let [short, long] = [short, "long.png"].map(|name| std::fs::read(place.path(name)).unwrap());
        assert!(short == long, "{technique}");
    }
}

#[test]
fn wrong_options_of_light_are_refused() {
    let place = Place::new();
    let mut all = String::new();
    for arguments in ["--threshold 0", "--threshold x", "--size 0x9", "--scene fence", "--scene studios"] {
        let said = place.run(&format!("light -o p.png {arguments}"));
        all += &format!("== {arguments}\n{}", said.all());
    }
    assert_eq!(place.files(), Vec::<String>::new());
    insta::assert_snapshot!(all);
}

/// One capture for each function, and each is evaluated as it was.
#[test]
fn inputs_of_every_function_are_captured() {
    let place = Place::new();
    place.table("double_product.ron").table("spherical_gaussian.ron");
    for name in ["frame.csv", "frame.bin"] {
        let said = place.run(&format!("render {STUDIO} --technique integrals --capture {name}"));
        assert_eq!(said.all(), "exit code: 0\n");
    }
    let mut rows = Vec::new();
    for (table, function) in
        [("double_product", "moments"), ("spherical_gaussian", "alpha"), ("spherical_gaussian", "beta")]
    {
        let files = [format!("frame-{table}_{function}.csv"), format!("frame-{table}_{function}.bin")];
        let [text, binary] = files.map(|file| {
            let said = place.run(&format!("eval {table}.ron --function {function} --input {file}"));
            assert_eq!(said.code, Some(0), "{file}: {}", said.err);
            said.out
        });
        assert!(text == binary, "{table} {function}");
        rows.push(text.lines().count() - 1);
    }
    assert!(rows[0] > 1000 && rows[1] > 1000 && rows[1] == rows[2], "{rows:?}");
    let said = place.run(&format!("render {STUDIO} --technique integrals --capture -"));
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("do not go to one place"), "{}", said.err);
}

/// On a contact sheet the error stands beside the name, and what cannot be done is said by the technique's name.
#[test]
#[cfg(feature = "gpu")]
fn integrals_are_compared_with_their_truth() {
    let place = Place::new();
    let said = place.run(&format!("render {STUDIO} --compare integrals,brute_force -o sheet.png"));
    assert_eq!(said.all(), "exit code: 0\n");
    let mut all = String::new();
    for command in [
        "quality --scenes studio --techniques integrals",
        "bench --techniques brute_force --backend cpu",
        "bench --techniques integrals --scene fence --backend cpu",
        "render --technique integrals --scene studio --cases -o p.png",
        "render --technique brute_force --scene studio --capture c.csv",
        "render --technique integrals --scene fence --backend cpu -o p.png",
    ] {
        let said = place.run(command);
        all += &format!("== {command}\n{}", said.all());
    }
    insta::assert_snapshot!(all);
}

/// Stages on the CPU, without any adapter.
#[test]
#[cfg(feature = "gpu")]
fn stages_are_measured_on_the_cpu() {
    let place = Place::new();
    let passes = |arguments: &str| {
        let said = place.run(&format!("bench {arguments} --backend cpu --rounds 2 --warm-up 0 --message-format json"));
        assert_eq!(said.code, Some(0), "{}", said.err);
        let object: serde_json::Value = serde_json::from_str(&said.out).unwrap();
        assert_eq!((&object["device"], &object["clock"]), (&"CPU".into(), &"wall clock".into()));
        let passes = object["passes"].as_array().unwrap().clone();
        assert!(passes.iter().all(|pass| pass["ms"].as_f64().unwrap() > 0.0), "{}", said.out);
        let names =
            passes.iter().map(|pass| [&pass["technique"], &pass["pass"]].map(|name| name.as_str().unwrap().to_owned()));
        (object["shadow_map"].clone(), names.collect::<Vec<_>>())
    };
    let (map, shadows) = passes("--scene text --size 48x27 --shadow-map 64 --techniques hard,rsmss");
    let expected = ["hard", "rsmss"].map(|name| ["shadow map", "receivers", "visibility"].map(|pass| [name, pass]));
    assert_eq!(
        (map, shadows),
        (64.into(), expected.concat().into_iter().map(|names| names.map(str::to_owned)).collect())
    );
    let (map, light) = passes("--scene studio --size 16x9 --techniques integrals");
    assert_eq!((map, light), (serde_json::Value::Null, vec![["integrals", "light"].map(str::to_owned)]));
}

#[test]
#[cfg(feature = "gpu")]
fn passes_of_integrals_are_measured() {
    if crate::support::adapter().is_none() {
        return;
    }
    let place = Place::new();
    let said = place.run("bench --scene studio --size 16x9 --techniques integrals --rounds 1 --warm-up 0");
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.starts_with("studio, 16x9; ") && said.out.contains(" integrals  compute "), "{}", said.out);
}
