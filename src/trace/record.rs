//! What the camera paths of a pixel meet, vertex by vertex, so that one pixel of one pass can be replayed.
//!
//! A recorder travels with the tally where one is asked for and reads what the path computes; it changes
//! no value. Without one, each place that could be recorded costs a branch.

use super::branch::{BOUNCE, Branch, MIRROR, REFLECTED, REFRACTED};
use super::caustic::Caustic;
use super::{Sample, Tally};
use crate::build::{Crossing, Surface, World};
use crate::math::{Color, DVec2};
use crate::optics::Interface;
use serde::Serialize;

/// What sends a path on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Event {
    /// From the eye.
    Camera,
    /// By the mirror layer.
    Mirrored,
    /// By an interface, back.
    Reflected,
    /// By an interface, through.
    Refracted,
    /// By a diffuse surface, for indirect light.
    Diffuse,
    /// By a surface that does not exist within an object of higher priority.
    Unnoticed,
}

/// What becomes of a way on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    Followed,
    /// It carried little, and chance ended it; those that survive weigh more.
    Roulette,
    /// By the limit of specular events in a row.
    DepthLimit,
    /// It carried nothing.
    Weightless,
}

/// A way on from a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sent {
    pub event: Event,
    pub fate: Fate,
    /// What it carries of the sample's light, before chance decides.
    pub throughput: [f32; 3],
    /// The vertex that it leads to, as its place in the sample's list.
    pub to: Option<usize>,
}

/// Light of one emitter that a surface reflects on along the path; the emitter is in view, or it is 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightRecord {
    pub light: String,
    /// W·m⁻²·sr⁻¹ from the vertex.
    pub radiance: [f32; 3],
}

/// What photons bring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PhotonRecord {
    /// W·m⁻²·sr⁻¹ from the vertex.
    pub radiance: [f32; 3],
    /// Photons in the estimate.
    pub photons: u32,
    /// Of the disc that they were gathered on, metres.
    pub radius: f32,
}

/// A surface that a path met.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Met {
    pub object: String,
    pub material: String,
    /// Scene coordinates, metres.
    pub position: [f64; 3],
    /// Unit geometric normal, out of the object.
    pub normal: [f64; 3],
    /// Metres from the vertex before.
    pub distance: f64,
}

/// Indices of refraction on both sides of an interface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct InterfaceRecord {
    pub near_ior: f64,
    pub far_ior: f64,
    /// Fresnel's share.
    pub reflectance: f64,
    /// µm, where a medium disperses.
    pub wavelength_um: Option<f64>,
}

/// A place where a path does something, or its end out of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vertex {
    /// The vertex before, as its place in the sample's list; none from the eye.
    pub from: Option<usize>,
    /// How the path came here.
    pub by: Event,
    /// What of the light that leaves here towards the vertex before reaches the eye: on arrival, with what
    /// chance has added and what media have absorbed.
    pub throughput: [f32; 3],
    /// None where the path leaves the scene.
    pub met: Option<Met>,
    pub interface: Option<InterfaceRecord>,
    /// Radiance of the surface's own, W·m⁻²·sr⁻¹, and by the scene's constant ambient light.
    pub emitted: [f32; 3],
    pub ambient: [f32; 3],
    pub lights: Vec<LightRecord>,
    pub caustic: Option<PhotonRecord>,
    /// Where photons find indirect light.
    pub indirect: Option<PhotonRecord>,
    /// What the vertex adds to the sample: throughput times all light that leaves from here.
    pub adds: [f32; 3],
    pub sends: Vec<Sent>,
}

/// A camera sample.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SampleRecord {
    /// Pixels from the top left corner of the image.
    pub film: [f64; 2],
    /// Its weight in the pixel's value, of all samples' weights; 0 where it was only looked at.
    pub weight: f64,
    /// In the order in which they were met.
    pub vertices: Vec<Vertex>,
    /// The sum of what they add.
    pub radiance: [f32; 3],
    /// Whether it is not finite, or more than can be added up, so that it does not count.
    pub dropped: bool,
}

/// Takes down what is traced.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    samples: Vec<SampleRecord>,
    /// By branch that is still to be followed: its vertex, and which of that vertex's ways on it is.
    pending: Vec<(usize, usize)>,
}

impl Tally {
    /// Has what is traced from now on taken down.
    pub(super) fn record(&mut self) {
        self.recorder = Some(Box::default());
    }

    #[inline(always)]
    pub(super) fn note(&mut self, what: impl FnOnce(&mut Recorder)) {
        if let Some(recorder) = &mut self.recorder {
            what(recorder);
        }
    }
}

impl Recorder {
    /// What was taken down; weights add up to 1.
    pub fn into_samples(mut self) -> Vec<SampleRecord> {
        let sum: f64 = self.samples.iter().map(|sample| sample.weight).sum();
        if sum > 0.0 {
            self.samples.iter_mut().for_each(|sample| sample.weight /= sum);
        }
        self.samples
    }

    #[cold]
    pub(super) fn begin(&mut self, film: DVec2) {
        self.pending.clear();
        self.samples.push(SampleRecord { film: film.to_array(), ..SampleRecord::default() });
    }

    #[cold]
    pub(super) fn end(&mut self, found: &Sample) {
        if let Some(sample) = self.samples.last_mut() {
            sample.radiance = found.radiance.to_array();
            sample.dropped = !found.is_finite();
        }
    }

    /// Adds to a sample's weight in the pixel, by its place among all that were traced.
    #[cold]
    pub(super) fn weigh(&mut self, place: u32, weight: f64) {
        if let Some(sample) = self.samples.get_mut(place as usize) {
            sample.weight += weight;
        }
    }

    /// The same of the latest sample.
    #[cold]
    pub(super) fn weigh_last(&mut self, weight: f64) {
        self.weigh(self.samples.len().wrapping_sub(1) as u32, weight);
    }

    fn vertices(&mut self) -> Option<&mut Vec<Vertex>> {
        self.samples.last_mut().map(|sample| &mut sample.vertices)
    }

    fn vertex(&mut self) -> Option<&mut Vertex> {
        self.vertices()?.last_mut()
    }

    /// A branch is followed: that which was sent last of those that are pending.
    #[cold]
    pub(super) fn arrive(&mut self) {
        let came = self.pending.pop();
        let Some(vertices) = self.vertices() else { return };
        let (here, mut by) = (vertices.len(), Event::Camera);
        if let Some((from, way)) = came {
            let sent = &mut vertices[from].sends[way];
            (sent.to, by) = (Some(here), sent.event);
        }
        vertices.push(Vertex {
            from: came.map(|(from, _)| from),
            by,
            throughput: [0.0; 3],
            met: None,
            interface: None,
            emitted: [0.0; 3],
            ambient: [0.0; 3],
            lights: Vec::new(),
            caustic: None,
            indirect: None,
            adds: [0.0; 3],
            sends: Vec::new(),
        });
    }

    #[cold]
    pub(super) fn meet(&mut self, world: &World, surface: &Surface, emitted: Color) {
        let object = world.instances[surface.instance as usize].object;
        let met = Met {
            object: world.object_names[object as usize].clone(),
            material: world.material_names[surface.material.0 as usize].clone(),
            position: (surface.p + world.origin).to_array(),
            normal: surface.ng.to_array(),
            distance: surface.t,
        };
        if let Some(vertex) = self.vertex() {
            (vertex.met, vertex.emitted) = (Some(met), emitted.to_array());
        }
    }

    /// A surface that does not exist for the path.
    #[cold]
    pub(super) fn pass(&mut self, world: &World, surface: &Surface, throughput: Color) {
        self.meet(world, surface, Color::ZERO);
        self.deposit(throughput, Color::ZERO);
    }

    #[cold]
    pub(super) fn interface(&mut self, interface: InterfaceRecord) {
        if let Some(vertex) = self.vertex() {
            vertex.interface = Some(interface);
        }
    }

    #[cold]
    pub(super) fn ambient(&mut self, radiance: Color) {
        if let Some(vertex) = self.vertex() {
            vertex.ambient = radiance.to_array();
        }
    }

    #[cold]
    pub(super) fn light(&mut self, light: &str, radiance: Color) {
        if let Some(vertex) = self.vertex() {
            vertex.lights.push(LightRecord { light: light.to_owned(), radiance: radiance.to_array() });
        }
    }

    #[cold]
    pub(super) fn caustic(&mut self, found: &Caustic) {
        if let Some(vertex) = self.vertex() {
            vertex.caustic = Some(found.into());
        }
    }

    #[cold]
    pub(super) fn indirect(&mut self, found: &Caustic) {
        if let Some(vertex) = self.vertex() {
            vertex.indirect = Some(found.into());
        }
    }

    #[cold]
    pub(super) fn deposit(&mut self, throughput: Color, radiance: Color) {
        if let Some(vertex) = self.vertex() {
            (vertex.throughput, vertex.adds) = (throughput.to_array(), radiance.to_array());
        }
    }

    /// A way on, by the number of its event, and what becomes of it.
    #[cold]
    pub(super) fn send(&mut self, throughput: Color, event: u64, fate: Fate) {
        let event = match event {
            MIRROR => Event::Mirrored,
            REFLECTED => Event::Reflected,
            REFRACTED => Event::Refracted,
            BOUNCE => Event::Diffuse,
            _ => Event::Unnoticed,
        };
        let throughput = throughput.to_array();
        let Some(vertices) = self.vertices() else { return };
        let from = vertices.len().wrapping_sub(1);
        let Some(vertex) = vertices.last_mut() else { return };
        vertex.sends.push(Sent { event, fate, throughput, to: None });
        let way = vertex.sends.len() - 1;
        if fate == Fate::Followed {
            self.pending.push((from, way));
        }
    }
}

impl InterfaceRecord {
    #[cold]
    pub(super) fn new(
        world: &World,
        branch: &Branch,
        crossing: &Crossing,
        wavelength_um: Option<f64>,
        interface: &Interface,
    ) -> InterfaceRecord {
        InterfaceRecord {
            near_ior: world.medium(&branch.media).0.ior(wavelength_um),
            far_ior: world.medium(&crossing.after).0.ior(wavelength_um),
            reflectance: interface.reflectance,
            wavelength_um,
        }
    }
}

impl From<&Caustic> for PhotonRecord {
    fn from(found: &Caustic) -> PhotonRecord {
        PhotonRecord { radiance: found.radiance.to_array(), photons: found.photons, radius: found.radius }
    }
}
