#pragma once
// Scenes built in code, for closed forms.

#include "renderer/scene/scene.h"

namespace chiaro::test {

using renderer::Vec3f;

renderer::Material lambert(Vec3f albedo, Vec3f emission = {});

// Adds a mesh with one instance at the origin.
void add_mesh(renderer::Scene& scene, renderer::Mesh mesh, const renderer::Material& material, const std::string& name);

// A rectangle corner, corner + u, corner + u + v, corner + v, cut into n × n cells; its normal is u × v.
renderer::Mesh rectangle(Vec3f corner, Vec3f u, Vec3f v, int n = 1);

// A closed box from the origin to `size`, its normals to the inside.
renderer::Mesh room(Vec3f size, int n = 1);

// A sphere of latitude bands; normals outwards, or inwards.
renderer::Mesh sphere(Vec3f center, float radius, int bands, bool inwards = false);

// An open plane y = 0, facing up, 10 × 10 m around the origin.
renderer::Scene plane_scene(Vec3f albedo);

// A floor, two walls and a ball: small, with shadows and colour bleeding. 4 × 3 × 4 m.
renderer::Scene corner_with_ball();

}  // namespace chiaro::test
