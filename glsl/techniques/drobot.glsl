/*---
summary = "One representative point for the diffuse lobe, one at the middle of the light's part in the lobe's cone for the specular"
citation = "Drobot 2014"
author_note = "our reading of Drobot: for rectangle and disk his eq. 1.15 with the light's solid angle, as Lagarde & de Rousiers 2014 read it too, because only so does his stated error come out (eq. 1.16 by the word, its dA the whole light's, is extent=area and several times too bright near a light); the shipped point=halfway brought onto the light, without which a small light's place would not matter; cone=threshold, his cone's rule, by eq. 1.18 for Phong and Blinn-Phong, at the same 1/e for the others, which he names without a formula; his sphere's diffuse in closed form. Ours: the skew where the surface faces away from the light's plane, the cone's tilt where the mirror direction does, excess=cut, cone=energy. point=plane+bisector=sum is his pseudo code by the word. He shipped rectangles with a Phong lobe only, because of artefacts with Blinn-Phong; footprint=elongated is what he proposes for them (§1.6), its sides derived by us. Textures by his look-ups of eqs. 1.24 and 1.28, each over the same integral of a white light, stored in mip levels as he shipped them: diffuse by distance at the diffuse point, specular by the cone's radius on the light (his g') at the middle of its part, always of Phong's lobe"
shapes = ["rectangle", "disk", "sphere"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx", "ggx_separable", "beckmann", "blinn_phong", "ward", "phong"]
diffuse_brdfs = ["lambert", "disney"]
effects = ["two_sided", "fresnel", "many_lights", "textured"]
exact = ["lambert_sphere", "point_limit", "mirror_limit"]

[[option]]
name = "point"
summary = "which point stands for the diffuse light"
choices = [
  ["closest", "between the points of the light closest to both maxima (his accurate form, stated error 0.05)"],
  ["halfway", "between both maxima on the light's plane, then the closest point of the light (his shipped form, stated error 0.15)"],
  ["plane", "between both maxima on the light's plane, on the light or not (his pseudo code)"],
]

[[option]]
name = "bisector"
summary = "the halfway vector to the diffuse point"
choices = [
  ["unit", "of unit vectors, as his eq. 1.9 has halfway vectors and Lagarde & de Rousiers 2014 this one"],
  ["sum", "of the vectors as they come, as his pseudo code is printed: the middle between both points"],
]

[[option]]
name = "extent"
summary = "the light's extent in the diffuse integral"
choices = [
  ["solid_angle", "the light's solid angle (eq. 1.15)"],
  ["area", "the light's area · cosine / distance² at the point (eq. 1.16, its dA the whole area)"],
]

[[option]]
name = "cone"
summary = "the specular importance cone"
choices = [
  ["energy", "as wide as conserves the lobe's energy (ours)"],
  ["threshold", "where the lobe falls to 1/e of its peak (eq. 1.18's threshold, for GGX)"],
]

[[option]]
name = "footprint"
summary = "the cone's section with the light's plane"
choices = [
  ["disk", "a disk; over a rectangle the square of its area (his)"],
  ["elongated", "as long and wide as the lobe, clipped by the rectangle's sides, its centre of area (his further research)", { shape = "rectangle" }],
]

[[option]]
name = "excess"
summary = "what the one point makes of the light beyond what can be"
choices = [
  ["cut", "a form factor above 1, and a part of the light above its cone's own solid angle, are cut (ours)"],
  ["kept", "kept: he accepts overestimation"],
]

[published]
point = "halfway"
extent = "solid_angle"
cone = "threshold"
excess = "kept"

[[departs]]
law = "point_limit"
lobe = "diffuse"
when = { point = "plane" }
error = 0.32
why = "where a light stands beside the point does not matter"

[[departs]]
law = "point_limit"
lobe = "specular"
error = 0.93
why = "a plateau over the importance cone, dark beside it"

[[departs]]
law = "mirror_limit"
when = { cone = "threshold" }
error = 0.89
why = "a cone to 1/e holds 0.65 of the lobe of a GGX mirror, and too much of it at grazing view"

[[departs]]
law = "additive"
lobe = "diffuse"
error = 0.16
why = "each half has its own point"

[[departs]]
law = "additive"
lobe = "specular"
error = 0.35
why = "each half has its own point and overlap"
---*/
#include "brdf.glsl"
#include "bisector"
#include "diffuse"
#include "elongated_footprint.glsl"
#include "importance_cone.glsl"
#include "light_texture.glsl"
#include "representative_point.glsl"
#include "solid_angle.glsl"
#include "spherical_cap.glsl"

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  Radiance result;
  result.diffuse = vec3(0.0);
  result.specular = vec3(0.0);
  float n_dot_v = clamp(dot(surface.normal, to_view), 0.0, 1.0);
  vec3 mirror = surface.normal * (2.0 * dot(surface.normal, to_view)) - to_view;
#if CONE_ENERGY
  float cone_versine = EnergyConeVersine(surface.alpha, n_dot_v);
#else
  float cone_versine = ThresholdConeVersine(surface.alpha);
#endif

#if EFFECT_SPHERE
  if (light.shape == SHAPE_SPHERE) {
    Cap sphere = SphereCap(light.center - surface.position, light.half_size.x, surface.normal);
    result.diffuse = DiffuseAlbedo(surface, to_view, sphere.axis) * SphereFormFactor(dot(surface.normal, sphere.axis), sphere.versine);

    float cone_radius = AngleFromVersine(cone_versine);
    float sphere_radius = AngleFromVersine(sphere.versine);
    float versine = VersineBetween(mirror, sphere.axis);
    float between = AngleFromVersine(versine);
    float solid_angle = 2.0 * kPi * min(min(cone_versine, sphere.versine), 1.0) *
                        SmoothstepOverlap(cone_radius, sphere_radius, between);
    vec3 to_light = AlongArc(mirror, sphere.axis, versine, OverlapCenter(cone_radius, sphere_radius, between));
    result.specular = SpecularLobe(surface, to_view, to_light) * solid_angle;
  }
#endif
#if EFFECT_RECTANGLE || EFFECT_DISK
#if EFFECT_SPHERE
  if (light.shape != SHAPE_SPHERE)
#endif
  {
    // All in the light's frame.
    vec3 offset = surface.position - light.center;
    vec3 point = vec3(dot(offset, light.axis_x), dot(offset, light.axis_y), dot(offset, light.normal));
    point.z = max(point.z, 1e-6 * (light.half_size.x + light.half_size.y));  // touching is taken as just above
    Surface local = surface;
    local.normal = vec3(dot(surface.normal, light.axis_x), dot(surface.normal, light.axis_y),
                        dot(surface.normal, light.normal));
    vec3 view = vec3(dot(to_view, light.axis_x), dot(to_view, light.axis_y), dot(to_view, light.normal));
    vec3 local_mirror = local.normal * (2.0 * dot(local.normal, view)) - view;

    vec2 foot = vec2(point.x, point.y);
    vec2 diffuse_hit;
    LitPart part;
    float solid_angle;
    vec2 normal_hit = NormalHit(point, local.normal);
#if POINT_CLOSEST
    vec2 nearest_hit = NearestHit(point, local.normal);
#else
    vec2 halfway_hit = HalfwayHit(point, normal_hit, vec2(0.0));
#endif
    Footprint footprint = ConeFootprint(point, local_mirror, cone_versine, CONE_ENERGY == 1);
#if EFFECT_DISK
#if EFFECT_RECTANGLE
    if (light.shape == SHAPE_DISK)
#endif
    {
      float radius = light.half_size.x;
#if POINT_CLOSEST
      diffuse_hit = HalfwayHit(point, ClosestOnDisk(foot, normal_hit, radius), ClosestOnDisk(foot, nearest_hit, radius));
#elif POINT_HALFWAY
      diffuse_hit = ClosestOnDisk(foot, halfway_hit, radius);
#else
      diffuse_hit = halfway_hit;
#endif
      part = FootprintOnDisk(footprint, radius);
#if EXTENT_SOLID_ANGLE
      solid_angle = DiskSolidAngle(point, radius);
#endif
    }
#if EFFECT_RECTANGLE
    else
#endif
#endif
#if EFFECT_RECTANGLE
    {
#if POINT_CLOSEST
      diffuse_hit = HalfwayHit(point, ClosestOnRectangle(foot, normal_hit, light.half_size),
                                ClosestOnRectangle(foot, nearest_hit, light.half_size));
#elif POINT_HALFWAY
      diffuse_hit = ClosestOnRectangle(foot, halfway_hit, light.half_size);
#else
      diffuse_hit = halfway_hit;
#endif
#if FOOTPRINT_DISK
      part = FootprintOnRectangle(footprint, light.half_size);
#else
      part = ElongatedFootprintOnRectangle(footprint, point, local.normal, local_mirror, ConeAcross(n_dot_v), light.half_size);
#endif
#if EXTENT_SOLID_ANGLE
      solid_angle = RectangleSolidAngle(point, light.half_size);
#endif
    }
#endif
    vec3 to_point = vec3(diffuse_hit, -point.z);
    float inverse_distance = inversesqrt(dot(to_point, to_point));
#if EXTENT_AREA
    solid_angle = light.area * point.z * inverse_distance * inverse_distance * inverse_distance;
#endif
    float form_factor = max(dot(local.normal, to_point) * inverse_distance, 0.0) * solid_angle / kPi;
#if EXCESS_CUT
    form_factor = min(form_factor, 1.0);
#endif
    result.diffuse = DiffuseAlbedo(local, view, to_point * inverse_distance) * form_factor;

#if EFFECT_TEXTURED
    float blur = BlurLevel(dot(to_point, to_point) / light.area);
    result.diffuse *= SampleLayer(light_solid_angle, vec3(TextureCoordinates(light, foot + diffuse_hit), light.image.x), blur).rgb;
#endif

    vec3 to_part = vec3(footprint.offset + part.shift, -point.z);
    inverse_distance = inversesqrt(dot(to_part, to_part));
    solid_angle = part.area * point.z * inverse_distance * inverse_distance * inverse_distance;
#if EXCESS_CUT
    // No part of the light within the cone is larger than the cone, nor than what lies above the horizon.
    solid_angle = min(solid_angle, 2.0 * kPi * min(cone_versine, 1.0));
#endif
    result.specular = SpecularLobe(local, view, to_part * inverse_distance) * solid_angle;
#if EFFECT_TEXTURED
    blur = BlurLevel(footprint.radius * footprint.radius / light.area);
    result.specular *= SampleLayer(light_phong, vec3(TextureCoordinates(light, footprint.center + part.shift), light.image.x), blur).rgb;
#endif
  }
#endif
  result.diffuse *= light.radiance;
  result.specular *= light.radiance;
  return result;
}
