//! The registry, and what every technique promises.

use super::*;

#[test]
fn names_are_found_and_unique() {
    for technique in ALL {
        assert_eq!(from_name(technique.name()).map(|found| found.name()).unwrap_or_default(), technique.name());
        assert!(!technique.doc().is_empty() && !technique.doc().ends_with('.'), "{technique}");
    }
    let mut all = names(|_| true);
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), ALL.len());
}

#[test]
fn settings_of_one_name_are_one_setting() {
    for technique in ALL {
        for declared in technique.settings() {
            assert_eq!(setting(declared.name), Some(declared), "{technique}");
            assert_eq!(declared.parse(&declared.default.to_string()), Ok(declared.default), "{technique}");
        }
        if let Some(truth) = technique.truth() {
            assert!(from_name(truth).is_ok(), "{technique}");
        }
    }
}

#[test]
fn settings_are_read_or_refused() {
    let rsmss = from_name("rsmss").unwrap_or_else(|e| panic!("{e}"));
    let hard = from_name("hard").unwrap_or_else(|e| panic!("{e}"));
    let limit = setting("search_limit").unwrap_or_else(|| panic!("is declared"));
    let read = read_settings(&[hard, rsmss], ["search_limit=7"]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(read.whole(limit), 7);
    let refused = |pair: &str| read_settings(&[rsmss], [pair]).err().map_or(String::new(), |e| e.to_string());
    assert!(refused("search_limits=7").contains("did you mean `search_limit`?"));
    assert!(refused("search_limit=0").contains("expected a whole number from 1 to 4096"));
    assert!(refused("search_limit").contains("write NAME=VALUE"));
    assert!(read_settings(&[hard], ["search_limit=7"]).is_err());
}

#[test]
fn what_lacks_an_ability_is_told_who_has_it() {
    let hard = from_name("hard").unwrap_or_else(|e| panic!("{e}"));
    let said = require(hard, Ability::Cases, "--cases").err().map_or(String::new(), |e| e.to_string());
    assert!(said.contains("`--cases` needs a technique with a table of cases, and hard has none"), "{said}");
    assert!(said.contains("the techniques with a table of cases are smsr, rsmss and rpcf"), "{said}");
    assert!(ALL.iter().any(|technique| require(*technique, Ability::Cases, "").is_ok()));
}
