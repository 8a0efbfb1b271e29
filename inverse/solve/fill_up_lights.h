#pragma once

#include "inverse/solve/observations.h"
#include "inverse/solve/stage_clock.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

// When there is no more time, and how a fill-up is told to stop.
struct FillUpLimits {
  const StageClock& clock;
  const renderer::Control& control;
};

// At least `wanted` lights where places for them are found, whatever few of them explain: those given that are not
// dark, and further ones where they explain most of what is left, or once time is out where one fits; if need be all of
// them elsewhere. None is dark, unless all are; intensities keep to the observations' rules. Enough lights come back as
// they are.
LightEstimates filled_up(const LightResponse& response, const Observations& observations, LightEstimates lights,
                         std::size_t wanted, const FillUpLimits& limits);

// Gives each dark light a small part of the brightest, whose colour the rules allow.
void light_the_dark(LightEstimates& lights);

}  // namespace chiaro::inverse
