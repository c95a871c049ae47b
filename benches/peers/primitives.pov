// The scene of scenes/yardstick/primitives.ron for POV-Ray 3.7, whose z axis points away from the
// eye: all z change sign. Radiance is a quarter of ours, so that nothing exceeds 1 in its 16 bits.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 ambient_light 0 }
#default { finish { ambient 0 emission 0 diffuse 1 specular 0 phong 0 } }
background { rgb 0 }

camera {
    location <0, 2.4, -6>
    right x * image_width / image_height
    up y
    angle 2 * degrees(atan(tan(radians(20)) * image_width / image_height))
    look_at <0, 0.5, 0.5>
}

// POV-Ray's light falls as 2 / (1 + (r/d)^2), nearly 2 d^2 / r^2 beyond d, and its diffuse surfaces
// lack the 1/pi.
#declare D = 0.01;
light_source { <-3, 6, -4> rgb 300 / pi / (2 * D * D) / 4 fade_distance D fade_power 2 }

polygon {
    5, <-10, 0, -10>, <10, 0, -10>, <10, 0, 10>, <-10, 0, 10>, <-10, 0, -10>
    pigment { checker rgb 0.8, rgb 0.2 translate y * -0.5 }
}

#macro Blend(X, Km)
    sphere { <X, 0.5, 0>, 0.5 pigment { rgb <0.7, 0.2, 0.2> } finish { diffuse 1 - Km reflection { Km } } }
#end
Blend(-2.4, 0)
Blend(-1.2, 0.25)
Blend(0, 0.5)
Blend(1.2, 0.75)
Blend(2.4, 1)

// POV-Ray lets light through glass in straight lines; ours blocks it. A copy within, which only
// shadow rays meet, blocks it here.
#macro Glass(Shape)
    object {
        Shape
        pigment { rgbt 1 }
        finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
        interior { ior 1.5 }
        Place()
    }
    object { Shape scale 0.9999 pigment { rgb 0 } no_image no_reflection Place() }
#end
#macro Place() rotate y * -30 translate <-2, 0.5, 1.6> #end
Glass(box { -0.5, 0.5 })
#macro Place() translate <-0.7, 0.5, 1.6> #end
Glass(sphere { 0, 0.5 })

cone { <0.7, 0, 1.6>, 0.5, <0.7, 1.2, 1.6>, 0 pigment { rgb <0.2, 0.4, 0.7> } }
cylinder { <2, 0, 1.6>, <2, 1, 1.6>, 0.45 pigment { rgb <0.2, 0.4, 0.7> } }
