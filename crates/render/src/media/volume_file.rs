//! Mitsuba's grid volumes (`.vol`, version 3), little-endian: the letters `VOL`, a byte 3, then 32-bit integers: the encoding (1:
//! 32-bit floats, 3: bytes that stand for 0 to 1), cells along x, y and z, channels; six 32-bit floats: two corners; and the
//! samples, x fastest.

use super::voxels::Voxels;
use kirkas_geometry::DVec3;

/// What such a file holds.
#[derive(Clone, Debug)]
pub struct VolumeFile {
    /// The samples.
    pub voxels: Voxels,
    /// Lower and upper corner.
    pub bounds: [DVec3; 2],
}

const HEADER: usize = 48;

/// From the file's bytes, or why not.
pub fn read(bytes: &[u8]) -> Result<VolumeFile, String> {
    if bytes.len() < HEADER || &bytes[..3] != b"VOL" {
        return Err("this is not a grid volume".into());
    }
    if bytes[3] != 3 {
        return Err(format!("version {} is not known, only 3", bytes[3]));
    }
    let word = |i: usize| [bytes[4 * i], bytes[4 * i + 1], bytes[4 * i + 2], bytes[4 * i + 3]];
    let integer = |i: usize| i32::from_le_bytes(word(i));
    let number = |i: usize| f64::from(f32::from_le_bytes(word(i)));
    let size = [2, 3, 4].map(|i| usize::try_from(integer(i)).unwrap_or(0));
    if integer(5) != 1 {
        return Err(format!("{} channels instead of one", integer(5)));
    }
    let data = &bytes[HEADER..];
    let values: Vec<f32> = match integer(1) {
        1 => data.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect(),
        3 => data.iter().map(|&b| f32::from(b) / 255.0).collect(),
        other => return Err(format!("encoding {other} is not known, only 1 (floats) and 3 (bytes)")),
    };
    let bounds = [DVec3::new(number(6), number(7), number(8)), DVec3::new(number(9), number(10), number(11))];
    let is_box = bounds[0].is_finite() && bounds[1].is_finite() && bounds[0].cmplt(bounds[1]).all();
    if !is_box {
        return Err("its corners make no box".into());
    }
    let [x, y, z] = size;
    let voxels = Voxels::new(size, values);
    let voxels = voxels
        .ok_or(format!("{x} x {y} x {z} samples are announced, and not that many finite ones of 0 or more follow"))?;
    Ok(VolumeFile { voxels, bounds })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(encoding: i32, size: [i32; 3], channels: i32, data: &[u8]) -> Vec<u8> {
        let mut bytes = b"VOL\x03".to_vec();
        [encoding, size[0], size[1], size[2], channels].iter().for_each(|i| bytes.extend(i.to_le_bytes()));
        [-1.0_f32, 0.0, 0.0, 1.0, 1.0, 2.0].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend(data);
        bytes
    }

    #[test]
    fn floats_and_bytes_are_read_x_fastest() {
        let floats: Vec<u8> = (0..6).flat_map(|i| (i as f32).to_le_bytes()).collect();
        let volume = read(&file(1, [2, 3, 1], 1, &floats)).unwrap();
        let cell = |at| volume.voxels.range(at, at);
        assert_eq!((cell([1, 0, 0]), cell([0, 2, 0])), ((1.0, 1.0), (4.0, 4.0)));
        assert_eq!(volume.bounds[1], DVec3::new(1.0, 1.0, 2.0));
        assert_eq!(read(&file(3, [2, 1, 1], 1, &[0, 255])).unwrap().voxels.at(DVec3::splat(0.5)), 0.5);
    }

    #[test]
    fn damaged_files_are_refused() {
        let nan = f32::NAN.to_le_bytes();
        for bytes in [
            vec![],
            b"VOL\x03".to_vec(),
            file(1, [1, 1, 1], 1, &[]),
            file(1, [1, 1, 1], 1, &nan),
            file(1, [i32::MAX; 3], 1, &[0; 4]),
            file(1, [-1, 1, 1], 1, &[0; 4]),
            file(2, [1, 1, 1], 1, &[0; 2]),
            file(3, [1, 1, 1], 3, &[0; 3]),
        ] {
            assert!(read(&bytes).is_err());
        }
    }
}
