#pragma once

#include "renderer/trace/trace_illumination.h"

namespace chiaro::inverse {

// Whether two spots of a surface see each other: nothing stands between them a tenth of their distance above it, which
// is beyond the bulge between normals 20° apart, nor lies upon either of them that close.
bool see_each_other(const renderer::RayTracer& tracer, const renderer::SurfaceSample& a,
                    const renderer::SurfaceSample& b);

}  // namespace chiaro::inverse
