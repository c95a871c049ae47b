//! A crop is that part of the whole picture.

use super::{ADAPTIVE, CAUSTIC, Lab};
use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};

/// Channel by channel: the values, with the size and the place of the data window, and the display window's size.
type Stored = (Vec<(String, Vec<f32>)>, [usize; 2], [i32; 2], [usize; 2]);

fn stored(lab: &Lab, name: &str) -> Stored {
    let file = read_first_flat_layer_from_file(lab.path(name)).expect("an EXR file");
    let layer = file.layer_data;
    let channels = layer.channel_data.list.into_iter().map(|channel| {
        let FlatSamples::F32(values) = channel.sample_data else { panic!("other than 32-bit floats") };
        (channel.name.to_string(), values)
    });
    let (size, place) = (layer.size, layer.attributes.layer_position);
    let shown = file.attributes.display_window.size;
    (channels.collect(), [size.0, size.1], [place.0, place.1], [shown.0, shown.1])
}

#[test]
fn a_crop_has_the_bits_of_the_whole_and_says_where_it_lies() {
    for (scene, more) in [
        (CAUSTIC, &["--passes", "3", "--aov", "normal,caustic"][..]),
        (ADAPTIVE, &["--aov", "depth,albedo"]),
        (ADAPTIVE, &["--set", "antialiasing=grid(2)", "--tile", "7"]),
    ] {
        let lab = Lab::new(scene);
        lab.render(&[&["-o", "whole.exr"], more].concat());
        let (whole, [width, height], ..) = stored(&lab, "whole.exr");
        let [x0, y0, x1, y1] = [5, 3, 38, 41];
        lab.render(&[&["-o", "crop.exr", "-o", "crop.png", "--crop", "5,3,38,41"], more].concat());
        let (crop, size, place, shown) = stored(&lab, "crop.exr");
        assert_eq!((size, place, shown), ([x1 - x0, y1 - y0], [x0 as i32, y0 as i32], [width, height]));
        for ((name, whole), (other, crop)) in whole.iter().zip(&crop) {
            assert_eq!(name, other);
            for y in y0..y1 {
                let row = &whole[y * width + x0..y * width + x1];
                let there = &crop[(y - y0) * (x1 - x0)..][..x1 - x0];
                assert!(row.iter().zip(there).all(|(a, b)| a.to_bits() == b.to_bits()), "{name}, row {y}");
            }
        }
        let png = image::open(lab.path("crop.png")).expect("a PNG");
        assert_eq!([png.width() as usize, png.height() as usize], size);
    }
}

#[test]
fn crops_beyond_the_image_are_refused() {
    let lab = Lab::new(CAUSTIC);
    let said = lab.fails(2, &["render", "scene.ron", "-o", "x.exr", "--crop", "0,0,61,44"]);
    assert!(said.contains("not within the image of 60 × 44 pixels"), "{said}");
    lab.fails(2, &["render", "scene.ron", "-o", "x.exr", "--crop", "4,4,4,9"]);
}
