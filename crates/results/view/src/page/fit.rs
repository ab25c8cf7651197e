//! Keeps a page below its size limit: what is left out, and what is refused.

use super::{Page, PageLayer, exact::Exact, page_field::Field, panes, worn::WearTrack};
use crate::ViewError;
use crate::appearance::field;
use stream::Table;

impl Page {
    /// Where regions are drawn and the cloud is too big: one point of so many, of which the rest can be judged.
    pub(super) fn every_so_many(&mut self, table: &Table) -> Option<Table> {
        self.options.pick.as_ref()?;
        // 6 bytes to draw, up to 24 to mark, 2 a column
        let bytes = table.rows() * (30 + 2 * table.columns().len());
        self.one_point_of = bytes.div_ceil(self.limit()).max(1);
        let rows: Vec<u32> = (0..table.rows() as u32).step_by(self.one_point_of).collect();
        Some(table.select(&rows))
    }

    /// Packed bytes that the page may have: base64 makes four of three.
    fn limit(&self) -> usize {
        (self.options.most_bytes / 4 * 3).max(1)
    }

    /// Packed bytes of everything so far.
    fn bytes(&self) -> usize {
        let exact = |l: &PageLayer| l.exact.as_ref().map_or(0, Exact::len);
        let layers = self.layers.iter().map(|l| l.frames.bytes() + l.wear.bytes() + exact(l));
        let worn = self.worn.values().map(WearTrack::bytes);
        layers.chain(self.surfaces.iter().map(panes::bytes)).chain(worn).sum()
    }

    /// Leaves out what may be left out while the page is too big: components of vectors, then frames.
    pub(super) fn fit(&mut self) -> Result<(), ViewError> {
        if self.bytes() > self.limit() && !self.options.components && !self.lengths_only {
            self.lengths_only = true;
            let kept = self.options.colour.as_deref().map(field::canonical);
            self.layers.iter_mut().for_each(|layer| layer.leave_components(kept));
        }
        while self.bytes() > self.limit() && self.layers.iter().any(|l| l.frames.len() > 2) {
            self.stride *= 2;
            let stride = self.stride;
            self.layers.iter_mut().for_each(|l| l.frames.thin(stride));
            let of_layers = self.layers.iter_mut().map(|l| &mut l.wear);
            of_layers.chain(self.worn.values_mut()).for_each(|track| track.thin(stride));
        }
        let Some(largest) = self.layers.iter().max_by_key(|l| l.frames.bytes()) else { return Ok(()) };
        if self.bytes() <= self.limit() {
            return Ok(());
        }
        Err(ViewError::TooBig {
            name: largest.name.clone(),
            count: largest.frames.last().map_or(0, |f| f.count),
            frames: largest.frames.len(),
            megabytes: (self.bytes() as f64 * 4.0 / 3.0 * 1.05 / 1e6).ceil(),
            limit: self.options.most_bytes as f64 / 1e6,
        })
    }
}

impl PageLayer {
    /// Leaves out the components of vectors whose length is a field; `kept` stays.
    fn leave_components(&mut self, kept: Option<&str>) {
        let lengths: Vec<&str> = self.fields.iter().map(|f| f.name.as_str()).collect();
        let stays = |f: &Field| {
            kept == Some(f.name.as_str()) || field::length_of(&f.name).is_none_or(|l| !lengths.contains(&l))
        };
        let stays: Vec<bool> = self.fields.iter().map(stays).collect();
        self.frames.keep_fields(&stays);
        let mut stays = stays.into_iter();
        self.fields.retain(|_| stays.next().unwrap_or(true));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PageOptions, Role};
    use stream::Values;

    /// Grains that all move.
    fn table(count: usize, time: f64) -> Table {
        let mut table = Table::default();
        for (n, name) in ["x", "y", "z", "vx", "vy", "vz"].into_iter().enumerate() {
            let value = |i: usize| ((i * (n + 3)) as f64).sin() + time;
            table.push(name, Values::F64((0..count).map(value).collect())).expect("as many rows");
        }
        table
    }

    fn page(most_bytes: usize, components: bool) -> (Page, usize) {
        let mut page = Page::new(PageOptions { most_bytes, components, ..PageOptions::default() });
        let layer = page.layer(Role::Grains, "run.mcap");
        (page, layer)
    }

    fn filled(most_bytes: usize, components: bool, frames: usize) -> Page {
        let (mut page, layer) = page(most_bytes, components);
        for frame in 0..frames {
            let time = frame as f64;
            page.push(layer, time, &table(1000, time)).expect("fits");
        }
        page
    }

    /// A frame of 1000 grains has 6 bytes each for the place and 2 for each of speed and its components.
    #[test]
    fn components_go_before_frames() {
        let roomy = filled(1_000_000, false, 8).kept();
        assert_eq!((roomy.kept, roomy.lengths_only, roomy.field_errors.len()), (8, false, 4));
        let tight = filled(100_000, false, 8).kept();
        assert_eq!((tight.kept, tight.lengths_only, tight.field_errors.len()), (8, true, 1));
        let kept = filled(100_000, true, 8).kept();
        assert_eq!((kept.kept, kept.stride, kept.lengths_only, kept.field_errors.len()), (5, 2, false, 4));
        let tighter = filled(40_000, false, 8).kept();
        assert_eq!((tighter.kept, tighter.stride, tighter.lengths_only), (3, 4, true));
    }

    #[test]
    fn what_cannot_be_thinned_is_refused_with_its_numbers() {
        let (mut page, layer) = page(10_000, false);
        let refused = page.push(layer, 0.0, &table(100_000, 0.0)).expect_err("800 kB of 10").to_string();
        for part in ["run.mcap: 100000 spheres", "a page of 2 MB", "limit is 0.01 MB", "--max-mb 2"] {
            assert!(refused.contains(part), "{part}: {refused}");
        }
    }

    #[test]
    fn of_a_cloud_to_draw_regions_on_some_points_are_enough() {
        let options =
            PageOptions { most_bytes: 100_000, pick: Some("a.ply".into()), ..PageOptions::default() };
        let mut page = Page::new(options);
        let layer = page.layer(Role::Cloud, "a.ply");
        page.push(layer, 0.0, &table(10_000, 0.0)).expect("fits");
        assert_eq!(page.kept().one_point_of, 6);
        let shown = page.layers[layer].frames.last().map_or(0, |f| f.count);
        assert_eq!(shown, 10_000_usize.div_ceil(6));
        assert!(page.bytes() <= page.limit());
    }
}
