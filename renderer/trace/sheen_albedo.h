#pragma once
// How much of the light a white sheen sends back, all directions together. alpha: roughness².

namespace chiaro::renderer {

// D V of the Charlie sheen.
float sheen_value(float cosine_h, float cosine_o, float cosine_i, float alpha);

// cosine: of the viewer, 0 … 1. From a table made on first use.
float sheen_albedo(float cosine, float alpha);

// Mean over cosine-weighted viewers.
float mean_sheen_albedo(float alpha);

// Mean of the larger of two cosine-weighted directions' albedos.
float mean_larger_sheen_albedo(float alpha);

}  // namespace chiaro::renderer
