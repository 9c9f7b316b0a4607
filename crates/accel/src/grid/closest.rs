//! The grid's search for the closest point: shells of cells around the one that is nearest, until a whole shell is too far
//! away. A way from the nearest cell to a farther shell leads through all shells between, and never back towards the point.

use super::Grid;
use crate::closest::{EnterPoint, PointSearch, PointSpace};
use crate::search::Level;

impl Grid {
    /// Look at all that may be closest; `enter` looks into an instance.
    pub fn closest_point(&self, level: Level, space: &PointSpace, search: &mut PointSearch, enter: EnterPoint) {
        for record in &self.unbounded {
            record.consider(level, space, search, enter);
        }
        let Some(cells) = &self.cells else { return };
        let planes = &cells.planes;
        let resolution = [0, 1, 2].map(|k| planes.resolution(k) as isize);
        let middle = [0, 1, 2].map(|k| *planes.touched(k, space.point[k], space.point[k]).start() as isize);
        let visit = |search: &mut PointSearch, at: [isize; 3]| {
            let at = at.map(|i| i as usize);
            let is_near = search.box_distance(space, &planes.cell(at)).is_some();
            if is_near {
                for &i in cells.lists.of(planes.index(at)) {
                    self.records[i as usize].consider(level, space, search, enter);
                }
            }
            is_near
        };
        let largest = resolution.into_iter().max().unwrap_or(0);
        for shell in 0..largest {
            let around = |k: usize| (middle[k] - shell).max(0)..=(middle[k] + shell).min(resolution[k] - 1);
            let mut is_near = false;
            for z in around(2) {
                for y in around(1) {
                    let on_shell = (z - middle[2]).abs() == shell || (y - middle[1]).abs() == shell;
                    // Within, the shell has only two cells in a row.
                    let step = if on_shell { 1 } else { 2 * shell as usize };
                    for x in (middle[0] - shell..=middle[0] + shell).step_by(step.max(1)) {
                        if x >= 0 && x < resolution[0] {
                            is_near |= visit(search, [x, y, z]);
                        }
                    }
                }
            }
            if !is_near {
                return;
            }
        }
    }
}
