#pragma once
// What the rough boundary of a solid loses where its facets scatter light but once: of all light from one direction,
// the part that they neither reflect nor let through, being in each other's way. GGX, Fresnel's equations.
// eta: refractive index of the far side over that of the near side.

namespace chiaro::renderer {

// cosine: of the viewer, 0 … 1; alpha: roughness². From tables made on first use of an index; accurate to about
// 0.01, for indices up to 3.
float boundary_loss(float cosine, float alpha, float eta);

// Mean over cosine-weighted viewers.
float mean_boundary_loss(float alpha, float eta);

// What a smooth boundary lets through of light from everywhere.
float mean_boundary_transmittance(float eta);

}  // namespace chiaro::renderer
