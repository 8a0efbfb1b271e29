#pragma once

#include "inverse/transport/light_response.h"

namespace chiaro::inverse {

// Any number of receivers that take direct light alone, from lights that may stand where `search` has them.
class DirectlyLit {
 public:
  // Keeps a reference to the tracer.
  DirectlyLit(const renderer::RayTracer& tracer, const LightResponse& search,
              const std::vector<renderer::SurfaceSample>& receivers);
  DirectlyLit(const DirectlyLit&) = delete;
  DirectlyLit& operator=(const DirectlyLit&) = delete;

  const LightResponse& response() const { return response_; }

 private:
  TransportCache transport_;
  LightResponse response_;
};

}  // namespace chiaro::inverse
