//! Wavefront OBJ → triangles.
//!
//! A file is bytes, not text: comments and names of materials are in any encoding.
//! Lines that describe faces are read, and those that describe their looks are passed over.
//! Surfaces of another kind are refused by name, as are unknown lines.

use glam::DVec3;

use super::{Assembly, Broken, Corner, Result, Triangle, no_faces, polygon};

/// Statements about looks, names and groups, and those that only serve free forms.
const PASSED_OVER: [&str; 32] = [
    "vt",
    "vp",
    "g",
    "o",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "lod",
    "bevel",
    "c_interp",
    "d_interp",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "cstype",
    "deg",
    "bmat",
    "step",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "csh",
    "vc",
    "res",
];

/// A face as written: its corners, a range of those of all faces, and its line.
struct Face {
    end: usize,
    line: usize,
}

/// Reads the faces of a file.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Triangle>> {
    let mut assembly = Assembly { positions: Vec::new(), normals: Vec::new(), triangles: Vec::new() };
    let (mut corners, mut faces) = (Vec::new(), Vec::new());
    for (line, text) in Statements::new(bytes) {
        let text = text.as_slice();
        statement(text, line, &mut assembly, &mut corners, &mut faces).map_err(|broken| in_line(broken, line))?;
    }
    let mut start = 0;
    for face in faces {
        add(&corners[start..face.end], &mut assembly).map_err(|broken| in_line(broken, face.line))?;
        start = face.end;
    }
    Ok(assembly.triangles)
}

fn in_line(broken: Broken, line: usize) -> Broken {
    Broken { what: format!("{} (line {line})", broken.what), ..broken }
}

fn statement(
    text: &[u8],
    line: usize,
    assembly: &mut Assembly,
    corners: &mut Vec<Corner>,
    faces: &mut Vec<Face>,
) -> Result<()> {
    let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).map(String::from_utf8_lossy);
    let Some(keyword) = words.next() else { return Ok(()) };
    match &*keyword {
        // A fourth number is a weight for free forms, further ones are a colour.
        "v" => assembly.positions.push(vector(words)?),
        "vn" => assembly.normals.push(vector(words)?),
        "f" | "fo" => {
            let start = corners.len();
            for word in words {
                corners.push(corner(&word, assembly)?);
            }
            if corners.len() - start < 3 {
                return Err(Broken::new("has a face of fewer than three corners", "export the mesh again"));
            }
            faces.push(Face { end: corners.len(), line });
        }
        "p" => return Err(no_faces("points")),
        "l" => return Err(no_faces("lines")),
        "curv" | "curv2" | "surf" | "bsp" | "bzp" | "cdc" | "cdp" => {
            let what = format!("has a curve or surface of free form (`{keyword}`)");
            return Err(Broken::new(what, "export it as polygons"));
        }
        "call" => return Err(Broken::new("calls another file (`call`)", "export it as one file")),
        word if PASSED_OVER.contains(&word) => {}
        word => {
            let word: String = word.chars().take(20).flat_map(char::escape_default).collect();
            let what = format!("has a statement `{word}`, which is unknown");
            return Err(Broken::new(what, "it was read as Wavefront OBJ; export the mesh again"));
        }
    }
    Ok(())
}

fn vector<'w>(words: impl Iterator<Item = std::borrow::Cow<'w, str>>) -> Result<DVec3> {
    let mut numbers = [0.0; 3];
    let mut found = 0;
    for (number, word) in numbers.iter_mut().zip(words) {
        *number = word.parse().map_err(|_| {
            let word: String = word.chars().take(20).flat_map(char::escape_default).collect();
            Broken::new(format!("has `{word}` where a number was expected"), "export the mesh again")
        })?;
        found += 1;
    }
    if found < 3 {
        return Err(Broken::new("has a vertex or normal of fewer than three numbers", "export the mesh again"));
    }
    Ok(DVec3::from_array(numbers))
}

/// A corner such as `3`, `3/1`, `3//2` or `-1/-1/-1`.
fn corner(word: &str, assembly: &Assembly) -> Result<Corner> {
    let wrong = || {
        let word: String = word.chars().take(20).flat_map(char::escape_default).collect();
        Broken::new(format!("has `{word}` where a corner of a face was expected"), "export the mesh again")
    };
    let index = |text: &str, count: usize| {
        let number: i64 = text.parse().map_err(|_| wrong())?;
        let counted = match number {
            0 => None,
            1.. => usize::try_from(number - 1).ok(),
            // Counted from the last one so far.
            ..0 => usize::try_from(number.unsigned_abs()).ok().and_then(|back| count.checked_sub(back)),
        };
        counted.ok_or_else(wrong)
    };
    let mut parts = word.split('/');
    let place = index(parts.next().unwrap_or_default(), assembly.positions.len())?;
    // Its place in a texture is of no interest.
    parts.next();
    let normal = parts.next().map(|text| index(text, assembly.normals.len())).transpose()?;
    if parts.next().is_some() { Err(wrong()) } else { Ok((place, normal)) }
}

/// Adds a face of any number of corners.
fn add(corners: &[Corner], assembly: &mut Assembly) -> Result<()> {
    if let Some((_, Some(normal))) =
        corners.iter().find(|(_, normal)| normal.is_some_and(|n| n >= assembly.normals.len()))
    {
        let what = format!("uses normal {} of {}", normal + 1, assembly.normals.len());
        return Err(Broken::new(what, "export the mesh again"));
    }
    if let [a, b, c] = *corners {
        return assembly.triangle([a, b, c]);
    }
    let places = corners.iter().map(|corner| assembly.place(*corner)).collect::<Result<Vec<_>>>()?;
    for triangle in polygon::triangles(&places)? {
        assembly.triangle(triangle.map(|index| corners[index]))?;
    }
    Ok(())
}

/// The statements of a file with the lines that they begin in: comments cut off, continued lines joined.
struct Statements<'b> {
    lines: std::iter::Enumerate<Box<dyn Iterator<Item = &'b [u8]> + 'b>>,
}

impl<'b> Statements<'b> {
    fn new(bytes: &'b [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
        let lines: Box<dyn Iterator<Item = &'b [u8]> + 'b> = Box::new(bytes.split(move |byte| *byte == end));
        Self { lines: lines.enumerate() }
    }
}

impl Iterator for Statements<'_> {
    type Item = (usize, Vec<u8>);

    fn next(&mut self) -> Option<Self::Item> {
        let (first, line) = self.lines.next()?;
        let mut line = line;
        let mut statement = Vec::new();
        loop {
            let end = line.iter().position(|byte| *byte == b'#').unwrap_or(line.len());
            let text = line[..end].trim_ascii_end();
            // A backslash at the end of a comment is part of the comment.
            match text.strip_suffix(b"\\").filter(|_| end == line.len()) {
                Some(text) => {
                    statement.extend_from_slice(text);
                    statement.push(b' ');
                    let Some((_, next)) = self.lines.next() else { break };
                    line = next;
                }
                None => {
                    statement.extend_from_slice(text);
                    break;
                }
            }
        }
        Some((first + 1, statement))
    }
}
