//! The catalogue: every hard case with the test that is named for it, what breaks, and the remedy with its
//! source. What this renderer does not have is listed with the reason.

/// A hard case.
pub struct Row {
    /// S for a formula of the course project, H for a hard case of the field.
    pub id: &'static str,
    /// Its test's name; empty where all of it is excluded.
    pub test: &'static str,
    /// What breaks, and why.
    pub case: &'static str,
    /// What is done about it, and whose idea that is.
    pub remedy: &'static str,
    /// What of it is not tested here, and why.
    pub excluded: &'static str,
}

const fn row(id: &'static str, test: &'static str, case: &'static str, remedy: &'static str) -> Row {
    Row { id, test, case, remedy, excluded: "" }
}

impl Row {
    const fn without(self, excluded: &'static str) -> Row {
        Row { excluded, ..self }
    }
}

/// Sections of the page, each with the rows that it begins with.
pub const SECTIONS: [(&str, &[Row]); 7] = [
    ("What the course project's formulas get wrong", SEED),
    ("Intersection and offsets", INTERSECTION),
    ("Glass and water", DIELECTRICS),
    ("Shading frames and transforms", FRAMES),
    ("Lights", LIGHTS),
    ("Photons, density estimation, energy", PHOTONS),
    ("Sampling, accumulation, output, input", SAMPLING),
];

const SEED: &[Row] = &[
    row("S1", "s01_mirror_direction", "R = I + 2(−R·N)N: R stands on both sides", "R = I + 2(−I·N)N"),
    row(
        "S2",
        "s02_photon_directions",
        "photons through uniform points on the flat faces of an icosahedron: 1.993 times as dense towards corners as towards the middles of faces",
        "directions uniform on the sphere, stratified by cells of equal solid angle",
    ),
    row(
        "S3",
        "s03_direct_light_counts_once",
        "a photon is stored wherever it meets a diffuse surface: direct light counts twice",
        "only light that has met a mirror or an interface first is stored",
    ),
    row(
        "S4",
        "s04_density_without_bias",
        "power over πr² with r the distance of the k-th photon: high by k/(k − 1), and 0/0 for r = 0",
        "the k-th photon chooses the radius and is left out of the sum",
    ),
    row(
        "S5",
        "s05_roulette_keeps_power",
        "roulette divides power by the probability and forgets the albedo: photons grow",
        "power times weight over probability; a ledger in double precision",
    ),
    row(
        "S6",
        "s06_layers_gain_nothing",
        "(1−kt)(1−km)(La+Ld) + kt(Lt+Lr) + km·Lm + Ls: gives back more than it gets where kt + km > 1",
        "layers from the outside in, a normalised highlight, checked",
    ),
    row(
        "S7",
        "s07_normal_map_axes",
        "tangents (x, 0, x·∂f/∂x) and (0, y, y·∂f/∂y): no number on the circles x = 0 and y = 0, infinite on z = 0",
        "tangents from the shape's coordinates; where those end, any frame (Duff and others, JCGT 6(1), 2017)",
    ),
    row(
        "S8",
        "s08_adaptive_antialiasing_ends",
        "pixels are divided while corners differ: what lies between them is missed, a bright edge never ends, exposure matters",
        "the centre is looked at too, depth is bounded, contrast is relative",
    ),
    row(
        "S9",
        "s09_sphere_light",
        "shadow rays to points inside of a spherical lamp: wrong penumbra and brightness",
        "directions uniform in the lamp's solid angle",
    ),
    row(
        "S10",
        "s10_radiance_across_interfaces",
        "radiance is carried over an interface unchanged",
        "radiance changes by (n₁/n₂)², photons' power does not (Veach 1997, ch. 5)",
    ),
];

const INTERSECTION: &[Row] = &[
    row(
        "H1",
        "h01_self_intersection",
        "a ray meets the surface that it leaves, the more so far from the origin, where one unit in the last place is a decimetre",
        "offsets from the hit's error bound (after Wächter and Binder, Ray Tracing Gems, ch. 6); coordinates centred on the scene",
    ),
    row(
        "H2",
        "h02_distant_spheres",
        "o·o − r² loses r when the sphere is far",
        "the discriminant from the distance of the line to the centre (Haines, Günther, Akenine-Möller, Ray Tracing Gems, ch. 7)",
    ),
    row(
        "H3",
        "h03_quadrics_and_rims",
        "rims of cylinders and cones are hit twice or never; absolute epsilons",
        "solids are met as an interval of the line, so that crossings come in pairs",
    ),
    row(
        "H4",
        "h04_planet_for_ground",
        "a ground of radius 1e6 m seen from 1.7 m: all rays graze, and in single precision a unit in the last place is 6 cm",
        "as H2, in double precision",
    ),
    row(
        "H5",
        "h05_mesh_cracks",
        "rays slip between triangles that share an edge",
        "watertight tests (Woop, Benthin, Wald, JCGT 2(1), 2013; Ize, JCGT 2(2), 2013)",
    ),
    row(
        "H6",
        "h06_false_hits",
        "rays nearly parallel to a needle of a triangle hit where nothing is",
        "where point on ray and point on triangle disagree, the test is done again in double precision",
    ),
    row(
        "H7",
        "h07_rays_through_edges",
        "a ray through an edge or corner meets no face or two, and inside and outside are exchanged",
        "ties go to the lowest index; media are a set, not a stack; near an edge a ray that goes on inside starts away from all faces",
    ),
    row(
        "H8",
        "h08_rays_in_faces",
        "an axis-parallel ray that lies in a box's face gives 0·∞ in the slab test",
        "the reciprocal is kept finite where a box is entered; minimum and maximum ignore what is no number",
    ),
    row(
        "H9",
        "h09_negative_zero",
        "a component −0 takes the other side of every comparison with 0",
        "the sign bit decides, as it does for the reciprocal",
    ),
    row(
        "H10",
        "h10_degenerate_triangles",
        "triangles without area have normals that are no numbers and poison the tree",
        "left out when read, counted, told",
    ),
    row(
        "H11",
        "h11_missing_normals",
        "a vertex normal of length zero cannot be normalised",
        "the triangle's own normal stands in",
    ),
];

const DIELECTRICS: &[Row] = &[
    row("H12", "h12_grazing_incidence", "Fresnel's equations are 0/0 at 90°", "cosines are clamped, terms ordered"),
    row(
        "H13",
        "h13_critical_angle",
        "the root of −ε at the critical angle",
        "total reflection is decided by sin²θ ≥ 1 before the root",
    ),
    row(
        "H14",
        "h14_index_of_the_surroundings",
        "glass of the index around it turns sharp direct light into blurred photons",
        "such an interface is none: no caster, no shadow, no photons",
    )
    .without("That is so of index 1. A solid of the index of another one around it is known to be none where a path meets it, not when the scene is planned: shadow rays end at it, and photons bring what it seems to hide."),
    row(
        "H15",
        "h15_indices_below_one",
        "indices below 1 turn total reflection around; 0, negative ones and NaN mean nothing",
        "0.05 to 10 is accepted, the rest refused with its place",
    ),
    row("H16", "", "rough glass: the half vector is on the wrong side under total reflection", "").without(
        "There is no rough glass: every interface is smooth, so there is no half vector and no loss of a single-scattering model to bound.",
    ),
    row(
        "H17",
        "h17_glass_against_water",
        "faces that coincide or overlap: the wrong pair of indices, speckle",
        "nested dielectrics by priority (Schmidt and Budge, JGT 7(2), 2002)",
    ),
    row(
        "H18",
        "h18_eye_inside_glass",
        "the medium at the eye is unknown, and with it the factor n²",
        "a probe finds the media at the eye; the output is radiance",
    ),
    row(
        "H19",
        "h19_open_and_hollow_glass",
        "open meshes, inner walls and reversed normals make a stack of media underflow",
        "media are a set that cannot underflow; open glass is warned of",
    )
    .without("A reversed mesh is compared with the mesh by means and worst pixels, to the noise of their samples, and not to the bit: its triangles are met in another order."),
];

const FRAMES: &[Row] = &[
    row(
        "H20",
        "h20_shadow_terminator",
        "a smooth coarse mesh shadows itself with its flat triangles",
        "shadow rays start on the curved surface (Hanika, Ray Tracing Gems II, ch. 4)",
    ),
    row(
        "H21",
        "h21_tilted_normals",
        "light leaks through tilted shading normals; photons and eye rays disagree",
        "sides are decided by the geometric normal; photons carry the adjoint factor (Veach 1997, 5.3)",
    ),
    row(
        "H22",
        "h22_flat_normal_maps",
        "normal maps at poles, at seams, under mirrored coordinates",
        "as S7; the map's axes follow the sign of the coordinates",
    ),
    row("H23", "h23_uneven_scale", "normals transformed like points", "the cofactors of the matrix"),
    row(
        "H24",
        "h24_mirrored_transforms",
        "a negative determinant exchanges inside and outside, and the tangents' handedness",
        "the sign of the determinant goes with the normals",
    )
    .without("With lamps that have an extent, glass and roulette the mirror image has other samples, and is compared to their noise; a scene without chance is compared to 1e-6."),
    row(
        "H25",
        "h25_singular_transforms",
        "the inverse of a flattening transform is infinite",
        "refused, with its place in the scene",
    ),
];

const LIGHTS: &[Row] = &[
    row(
        "H26",
        "h26_touching_area_lights",
        "1/d² near an area light",
        "sampling by solid angle (rectangles: Ureña, Fajardo, King 2013)",
    ),
    row(
        "H27",
        "h27_tiny_and_enclosing_sphere_lights",
        "1 − cosθ is 0 for a small lamp; the root of a negative number inside of one",
        "1 − cosθ = sin²θ/(1 + cosθ); inside, the whole sphere",
    )
    .without("A sphere of radius 0 is refused: it is given by its radiance, of which no power follows. The light `point` is what it would be."),
    row(
        "H28",
        "h28_lights_without_light",
        "the density of a black or sizeless lamp is 0/0",
        "such lamps are left out",
    ),
];

const PHOTONS: &[Row] = &[
    row("H29", "h29_fewer_photons_than_k", "with less than k photons there is no k-th", "the largest radius takes its place"),
    row(
        "H30",
        "h30_photons_on_a_line",
        "identical, collinear and coplanar photons never divide, or overflow a bucket",
        "the tree is built on turned coordinates; leaves are cut by count, not by place",
    )
    .without("The tree's depth cannot grow: nodes of eight lie in levels over leaves of sixteen photons, ⌈log₈(N/16)⌉ of them for N photons, wherever these are. Order among equal distances is not part of the result: sums are over sets."),
    row("H31", "h31_radius_zero", "all photons of a gather on one point: power over no area", "a floor under the radius: the pixel's footprint"),
    row(
        "H32",
        "h32_edges_and_thin_walls",
        "the gather disc reaches beyond an edge, or through a thin wall",
        "photons know their side; the disc is renormalised by the surface within it",
    ),
    row(
        "H33",
        "h33_nearest_photon_bias",
        "the k-nearest estimate is high by k/(k − 1); kernels that don't integrate to one",
        "the k-th photon is left out: relative deviation 1/√(k − 2)",
    )
    .without("There is no Gaussian kernel."),
    row("H34", "h34_power_ledger", "power is lost or doubled at splits, by roulette, at depth limits", "a ledger of every pass in double precision"),
    row(
        "H35",
        "h35_photons_agree_with_shadow_rays",
        "photons and shadow rays are emitted by different code",
        "photons can be stored where they arrive first, to be held against shadow rays",
    ),
    row("H36", "h36_scale_of_the_scene", "absolute radii, epsilons and thresholds", "every length is relative to the scene, the hit or the pixel"),
    row("H37", "h37_white_furnace", "energy leaks anywhere", "closed rooms and even skies, whose answer is known"),
    row("H38", "h38_roulette_and_depth", "truncation takes light away in silence", "roulette without bias; what the depth limit cuts is weighed and told")
        .without("Roulette has no switch: renders with it are held against the exact answer, not against renders without it."),
    row("H49", "h49_known_optics", "optics that a textbook states", ""),
    row("H50", "h50_caustic_seen_in_glass", "a caustic seen in a mirror or through glass, which path tracers do not find", "photons are gathered at the first diffuse surface after any specular chain"),
    row("H51", "h51_emission_is_uniform", "emission that favours directions", "warps of the unit square beside their densities, held against them by χ²"),
];

const SAMPLING: &[Row] = &[
    row("H39", "h39_no_overflow_in_the_file", "half-precision floats end at 65,504", "images are 32-bit; what is not finite is counted and written as 0")
        .without("No half-precision format is written, so that there is no clamp to 65,504 to count."),
    row("H40", "h40_a_million_passes", "in single precision a million times 0.1 is 100,958", "sums in double precision, in the order of the passes"),
    row("H41", "h41_variance_of_few_samples", "one sample has no variance; a large mean eats a small one", "unknown is said to be unknown; Welford's recurrence"),
    row("H42", "h42_bad_texels", "NaN, infinite and negative texels", "mended when read, counted by file, told"),
    row("H43", "h43_malformed_files", "empty, truncated, lying and hostile files", "typed errors with their place; limits before memory is taken")
        .without("PLY, glTF and MTL are not read. Each parser has its own tests of every truncation and of thousands of mutations; this row is what the program does. Of an image the file and the fault are named, not the byte: decoders do not tell it."),
    row("H44", "h44_extreme_image_sizes", "sizes whose product overflows or does not fit", "64-bit sizes; the image's memory is refused before it is taken"),
    row("H45", "h45_features_below_a_pixel", "wires thinner than a pixel; edges of any brightness", "samples over the whole pixel; bounded division"),
    row("H46", "h46_endless_reflections", "facing mirrors", "a loop, not recursion; what is cut is told"),
    row("H47", "h47_degenerate_cameras", "up along the view, eye at the target, angles of 0 and 180°, no pixels", "refused with the place, or replaced with a warning")
        .without("There is no orthographic camera."),
    row("H48", "h48_the_same_bits", "the picture depends on threads, tiles and the order of work", "values from (seed, stage, item, dimension); sums of fixed shape; libm")
        .without("Other processors and debug builds are not run by this table; no operation in the pixels' path is left to the platform."),
    row("H52", "h52_texture_coordinates", "u of 1, below 0, of 1e9 or NaN index beyond the image", "wrapped in double precision, then clamped"),
    row("H53", "h53_flushed_denormals", "a host that flushes denormal numbers to zero", "no result of ordinary scenes rests on denormals"),
    row("H54", "h54_png_curve", "approximate sRGB, truncation instead of rounding", "IEC 61966-2-1, halves to even, clamped pixels counted"),
];

pub fn all() -> impl Iterator<Item = &'static Row> {
    SECTIONS.iter().flat_map(|(_, rows)| rows.iter())
}
