//! The catalogue: every asset's path, and the function and seed that make it.

use std::fs;
use std::io;
use std::path::Path;

use rayon::prelude::*;

pub mod carriers;
pub mod crown;
pub mod disc;
pub mod erosion;
pub mod grass;
pub mod ground;
pub mod image;
pub mod lathe;
pub mod mesh;
pub mod noise;
pub mod pebble;
pub mod pine;
pub mod pool;
pub mod prism;
pub mod random;
pub mod sky;
pub mod solid;
pub mod sweep;
pub mod terrain;
pub mod textures;
pub mod torus;
pub mod tube;
pub mod water;

use self::ground::Top;
use self::terrain::Terrain;
use self::textures::{bark, brick, dots, grid, land, leaf, rock, wood};

/// One file: its path below the assets folder, and its whole content.
pub struct Asset {
    pub path: &'static str,
    pub bytes: Vec<u8>,
}

/// What several assets are made from.
struct Land {
    terrain: Terrain,
    top: Top,
    lie: land::Lie,
}

type Make = fn(&Land) -> Vec<u8>;

const CATALOGUE: &[(&str, Make)] = &[
    ("textures/terrain.png", |l| land::albedo(&l.terrain, &l.lie).png()),
    ("textures/terrain_normal.png", |l| land::normals(&l.terrain, &l.lie).png()),
    ("textures/brick.png", |_| brick::wall(31).albedo().png()),
    ("textures/brick_normal.png", |_| brick::wall(31).normals().png()),
    ("textures/wood.png", |_| wood::planks(41).png()),
    ("textures/rock.png", |_| rock::albedo(51).png()),
    ("textures/bark.png", |_| bark::albedo(61).png()),
    ("textures/bark_birch.png", |_| bark::birch(62).png()),
    ("textures/leaf.png", |_| leaf::albedo(71).png()),
    ("textures/grid.png", |_| grid::cells().png()),
    ("textures/bump_dots_normal.png", |_| dots::normals().png()),
    ("textures/flat_normal.png", |_| image::Image::filled(16, [128; 3]).with_flat_normal().png()),
    ("obj/terrain.obj", |l| ground::solid(&l.top).obj()),
    ("obj/meadow.obj", |l| carriers::meadow(&l.terrain, &l.top).obj()),
    ("obj/forest.obj", |l| carriers::forest(&l.terrain, &l.top).obj()),
    ("obj/beach.obj", |l| carriers::beach(&l.terrain, &l.top).obj()),
    ("obj/water.obj", |_| water::solid().obj()),
    ("obj/tree_pine.obj", |_| pine::tree(101).obj()),
    ("obj/tree_broadleaf.obj", |_| crown::broadleaf(111).obj()),
    ("obj/tree_birch.obj", |_| crown::birch(121).obj()),
    ("obj/bush.obj", |_| crown::bush(131).obj()),
    ("obj/grass_tuft.obj", |_| grass::tuft(141).obj()),
    ("obj/pebble_1.obj", |_| pebble::stone(151, [1.0, 0.62, 0.8]).obj()),
    ("obj/pebble_2.obj", |_| pebble::stone(152, [0.85, 0.5, 1.0]).obj()),
    ("obj/prism.obj", |_| prism::equilateral().obj()),
    ("obj/wine_glass.obj", |_| lathe::wine_glass().obj()),
    ("obj/wine.obj", |_| lathe::wine().obj()),
    ("obj/lens.obj", |_| lathe::lens().obj()),
    ("obj/pool_water.obj", |_| pool::water().obj()),
    ("obj/sweep.obj", |_| sweep::sweep().obj()),
    ("obj/torus.obj", |_| torus::coarse().obj()),
    ("env/evening.exr", |_| sky::evening()),
];

/// Makes every asset, in the catalogue's order.
pub fn assets() -> Vec<Asset> {
    let terrain = Terrain::new(7);
    let (top, lie) = rayon::join(|| ground::top(&terrain), || land::Lie::of(&terrain));
    let land = Land { terrain, top, lie };
    CATALOGUE.par_iter().map(|(path, make)| Asset { path, bytes: make(&land) }).collect()
}

/// Writes `assets` below `folder`, which is made when missing.
pub fn write(assets: &[Asset], folder: &Path) -> io::Result<()> {
    for asset in assets {
        let path = folder.join(asset.path);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::write(path, &asset.bytes)?;
    }
    Ok(())
}

/// One line for each of `assets` that is missing below `folder` or has other bytes there.
pub fn differences(assets: &[Asset], folder: &Path) -> Vec<String> {
    let difference = |asset: &Asset| match fs::read(folder.join(asset.path)) {
        Ok(bytes) if bytes == asset.bytes => None,
        Ok(bytes) => {
            Some(format!("{}: differs ({} bytes, made {})", asset.path, bytes.len(), asset.bytes.len()))
        }
        Err(error) => Some(format!("{}: {error}", asset.path)),
    };
    assets.iter().filter_map(difference).collect()
}
