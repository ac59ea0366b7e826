//! A small reader of `.vtu` files with zlib-compressed, base64-coded arrays in their places.

use base64::engine::general_purpose::STANDARD;
use base64::Engine;
use std::collections::BTreeMap;

pub struct Vtu {
    pub points: Vec<[f64; 3]>,
    pub connectivity: Vec<i64>,
    pub offsets: Vec<i64>,
    pub types: Vec<u8>,
    /// Of each cell's four sides, empty inside.
    pub boundary_names: Vec<String>,
    arrays: BTreeMap<String, Vec<u8>>,
}

impl Vtu {
    pub fn doubles(&self, name: &str) -> Vec<f64> {
        words(&self.arrays[name]).map(f64::from_le_bytes).collect()
    }

    pub fn integers(&self, name: &str) -> Vec<i32> {
        words(&self.arrays[name]).map(i32::from_le_bytes).collect()
    }
}

pub fn read(bytes: &[u8]) -> Vtu {
    let text = std::str::from_utf8(bytes).expect("base64 makes the file plain text");
    let document = roxmltree::Document::parse(text).expect("well-formed XML");
    let root = document.root_element();
    for (name, value) in [
        ("type", "UnstructuredGrid"),
        ("version", "2.2"),
        ("byte_order", "LittleEndian"),
        ("header_type", "UInt64"),
        ("compressor", "vtkZLibDataCompressor"),
    ] {
        assert_eq!(root.attribute(name), Some(value), "attribute {name}");
    }
    let find = |name: &str| root.descendants().find(|n| n.has_tag_name(name)).unwrap();
    let mut arrays = BTreeMap::new();
    for array in root.descendants().filter(|n| n.has_tag_name("DataArray")) {
        assert_eq!(array.attribute("format"), Some("binary"));
        arrays.insert(array.attribute("Name").unwrap().to_string(), decode(array.text().unwrap().trim()));
    }
    let codes = find("Array").text().unwrap();
    let codes: Vec<u8> = codes.split_whitespace().map(|c| c.parse().unwrap()).collect();
    let (last, codes) = codes.split_last().unwrap();
    assert_eq!((*last, find("Array").attribute("NumberOfComponents")), (0, Some("4")));
    let boundary_names =
        codes.split(|c| *c == 0).map(|s| String::from_utf8(s.to_vec()).unwrap()).collect::<Vec<_>>();
    let coordinates: Vec<f64> = words(&arrays["Points"]).map(f64::from_le_bytes).collect();
    let count = |name| find("Piece").attribute(name).unwrap().parse::<usize>().unwrap();
    assert_eq!(coordinates.len(), 3 * count("NumberOfPoints"));
    assert_eq!(arrays["types"].len(), count("NumberOfCells"));
    assert_eq!(boundary_names.len(), 4 * count("NumberOfCells"));
    // MFEM reads only grids that are one piece and nothing else.
    let grid = find("UnstructuredGrid");
    assert!(grid.children().filter(|n| n.is_element()).all(|n| n.has_tag_name("Piece")));
    Vtu {
        points: coordinates.chunks(3).map(|p| [p[0], p[1], p[2]]).collect(),
        connectivity: words(&arrays["connectivity"]).map(i64::from_le_bytes).collect(),
        offsets: words(&arrays["offsets"]).map(i64::from_le_bytes).collect(),
        types: arrays["types"].clone(),
        boundary_names,
        arrays,
    }
}

/// The array at the start of `text`: header and blocks are base64 runs of their own.
fn decode(text: &str) -> Vec<u8> {
    let run = |length: usize| length.div_ceil(3) * 4;
    let number =
        |bytes: &[u8], k: usize| u64::from_le_bytes(bytes[8 * k..8 * k + 8].try_into().unwrap()) as usize;
    let blocks = number(&STANDARD.decode(&text[..12]).unwrap(), 0);
    let header = STANDARD.decode(&text[..run(8 * (3 + blocks))]).unwrap();
    let (size, last) = (number(&header, 1), number(&header, 2));
    let sizes: Vec<usize> = (0..blocks).map(|b| number(&header, 3 + b)).collect();
    let start = run(header.len());
    assert_eq!(text.len(), start + run(sizes.iter().sum()), "nothing follows the blocks");
    let packed = STANDARD.decode(&text[start..]).unwrap();
    let (mut at, mut data) = (0, Vec::new());
    for (b, length) in sizes.into_iter().enumerate() {
        let block = miniz_oxide::inflate::decompress_to_vec_zlib(&packed[at..at + length]).unwrap();
        let expected = if b + 1 == blocks && last > 0 { last } else { size };
        assert_eq!(block.len(), expected, "length of block {b}");
        data.extend(block);
        at += length;
    }
    data
}

fn words<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [u8; N]> + '_ {
    bytes.chunks_exact(N).map(|c| c.try_into().unwrap())
}
