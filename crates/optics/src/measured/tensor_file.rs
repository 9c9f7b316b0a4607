//! Tensor files: named arrays of numbers, little endian, as the RGL database keeps its measurements.
//!
//! `tensor_file\0`, two bytes of version (1, 0), the number of fields as `u32`; then for each its name (`u16` length, bytes),
//! `u16` dimensions, `u8` kind of number, `u64` offset of its data from the file's beginning, and a `u64` per dimension.

/// What a file begins with.
pub const MAGIC: &[u8; 12] = b"tensor_file\0";

/// Kinds of numbers that are read, by their code: bytes and `f32`.
const U8: u8 = 1;
const F32: u8 = 10;
/// Length of a number of each kind, bytes.
const SIZES: [u64; 12] = [0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8];
/// More dimensions or fields are no measurement.
const MOST_DIMENSIONS: u16 = 8;
const MOST_FIELDS: u32 = 256;

/// A file's fields; their data stays where it is.
pub struct TensorFile<'a> {
    bytes: &'a [u8],
    fields: Vec<Field<'a>>,
}

struct Field<'a> {
    name: &'a [u8],
    kind: u8,
    shape: Vec<usize>,
    data: &'a [u8],
}

/// An array of `f32`.
pub struct Tensor {
    /// Length along each dimension, the slowest first.
    pub shape: Vec<usize>,
    /// All values, finite.
    pub values: Vec<f32>,
}

impl Tensor {
    /// Refuses it unless its first dimensions are `expected` and at least two vertices lie along each of the others.
    pub fn check(&self, name: &str, expected: &[usize]) -> Result<(), String> {
        let (first, last) = self.shape.split_at(expected.len());
        if first == expected && last.iter().all(|&n| n >= 2) {
            return Ok(());
        }
        Err(format!("its field `{name}` has the sizes {:?}, which do not go with the others", self.shape))
    }
}

/// Takes numbers from the front of some bytes.
struct Cursor<'a>(&'a [u8]);

impl<'a> Cursor<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (head, rest) = self.0.split_at_checked(count).ok_or("it ends within its table of fields")?;
        self.0 = rest;
        Ok(head)
    }
    fn number(&mut self, bytes: usize) -> Result<u64, String> {
        Ok(self.take(bytes)?.iter().rev().fold(0, |n, &b| n << 8 | u64::from(b)))
    }
}

impl<'a> TensorFile<'a> {
    /// The table of fields; every field lies within the file.
    pub fn read(bytes: &'a [u8]) -> Result<Self, String> {
        let mut cursor = Cursor(bytes);
        if cursor.take(MAGIC.len())? != MAGIC {
            return Err("it is no tensor file".into());
        }
        let version = (cursor.number(1)?, cursor.number(1)?);
        if version != (1, 0) {
            return Err(format!("it is of version {}.{}; only 1.0 is known", version.0, version.1));
        }
        let count = cursor.number(4)? as u32;
        if count > MOST_FIELDS {
            return Err(format!("it says that it has {count} fields"));
        }
        let mut file = TensorFile { bytes, fields: Vec::new() };
        for _ in 0..count {
            let field = file.field(&mut cursor)?;
            file.fields.push(field);
        }
        Ok(file)
    }

    fn field(&self, cursor: &mut Cursor<'a>) -> Result<Field<'a>, String> {
        let length = cursor.number(2)? as usize;
        let name = cursor.take(length)?;
        let shown = || name.escape_ascii().take(40).map(char::from).collect::<String>();
        let dimensions = cursor.number(2)? as u16;
        if dimensions > MOST_DIMENSIONS {
            return Err(format!("its field `{}` has {dimensions} dimensions", shown()));
        }
        let (kind, offset) = (cursor.number(1)? as u8, cursor.number(8)?);
        let shape = (0..dimensions).map(|_| cursor.number(8)).collect::<Result<Vec<_>, _>>()?;
        let size = SIZES.get(usize::from(kind)).copied().filter(|&s| s > 0);
        let size = size.ok_or_else(|| format!("its field `{}` is of the unknown kind {kind}", shown()))?;
        let length = shape.iter().try_fold(size, |n, &s| n.checked_mul(s));
        let end = length.and_then(|n| offset.checked_add(n)).filter(|&end| end <= self.bytes.len() as u64);
        let end = end.ok_or_else(|| format!("its field `{}` goes beyond the end of the file", shown()))?;
        let data = &self.bytes[offset as usize..end as usize];
        Ok(Field { name, kind, shape: shape.into_iter().map(|s| s as usize).collect(), data })
    }

    fn find(&self, name: &str, kind: u8, dimensions: usize) -> Result<&Field<'a>, String> {
        let field = self.fields.iter().find(|f| f.name == name.as_bytes());
        let field = field.ok_or_else(|| format!("it has no field `{name}`"))?;
        if field.kind != kind || field.shape.len() != dimensions {
            let said = (field.kind, field.shape.len());
            return Err(format!("its field `{name}` is of kind {} with {} dimensions", said.0, said.1));
        }
        Ok(field)
    }

    /// True when it has such a field.
    pub fn has(&self, name: &str) -> bool {
        self.fields.iter().any(|f| f.name == name.as_bytes())
    }

    /// A field of `f32`, all finite.
    pub fn floats(&self, name: &str, dimensions: usize) -> Result<Tensor, String> {
        let field = self.find(name, F32, dimensions)?;
        let (words, _) = field.data.as_chunks::<4>();
        let values: Vec<f32> = words.iter().map(|&w| f32::from_le_bytes(w)).collect();
        match values.iter().position(|v| !v.is_finite()) {
            Some(i) => Err(format!("value {i} of its field `{name}` is {}", values[i])),
            None => Ok(Tensor { shape: field.shape.clone(), values }),
        }
    }

    /// A field of bytes.
    pub fn bytes(&self, name: &str) -> Result<&'a [u8], String> {
        Ok(self.find(name, U8, 1)?.data)
    }
}

/// The bytes of a file with these fields of `f32`, and of bytes.
pub fn write(floats: &[(&str, &[usize], &[f32])], bytes: &[(&str, &[u8])]) -> Vec<u8> {
    let words = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let mut fields: Vec<(&str, u8, Vec<usize>, Vec<u8>)> =
        floats.iter().map(|(name, shape, values)| (*name, F32, shape.to_vec(), words(values))).collect();
    fields.extend(bytes.iter().map(|(name, data)| (*name, U8, vec![data.len()], data.to_vec())));
    let table: usize = fields.iter().map(|(name, _, shape, _)| 2 + name.len() + 2 + 1 + 8 + 8 * shape.len()).sum();
    let mut out = [&MAGIC[..], &[1, 0], &(fields.len() as u32).to_le_bytes()].concat();
    let mut offset = out.len() + table;
    for (name, kind, shape, data) in &fields {
        out.extend((name.len() as u16).to_le_bytes());
        out.extend(name.as_bytes());
        out.extend((shape.len() as u16).to_le_bytes());
        out.push(*kind);
        out.extend((offset as u64).to_le_bytes());
        shape.iter().for_each(|&n| out.extend((n as u64).to_le_bytes()));
        offset += data.len();
    }
    fields.iter().for_each(|(.., data)| out.extend(data));
    out
}
