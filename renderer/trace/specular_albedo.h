#pragma once
// How much of the light a GGX surface sends back, all directions together.

namespace chiaro::renderer {

// Directional albedo of single scattering from GGX with Schlick's Fresnel: E = f0 · scale + bias.
// Source: Karis, Real Shading in Unreal Engine 4, 2013 (split sum).
struct SpecularAlbedo {
  float scale = 0, bias = 0;
  float at(float f0) const { return f0 * scale + bias; }
  float at(float f0, float f90) const { return f0 * scale + f90 * bias; }
  float loss() const { return 1 - scale - bias; }  // what a perfect reflector of this roughness loses
};

// cosine: of the viewer, 0 … 1; alpha: roughness². From a table made on first use; accurate to about 0.003.
SpecularAlbedo specular_albedo(float cosine, float alpha);

// Mean over cosine-weighted viewers.
SpecularAlbedo mean_specular_albedo(float alpha);

// Mean of the larger of two cosine-weighted directions' albedos, of a clear coat.
float mean_larger_clearcoat_albedo(float alpha);

}  // namespace chiaro::renderer
