#pragma once

#include <cstdint>

namespace chiaro::inverse {

// Why a solve ended.
enum class Termination : std::uint8_t {
  kNoFurtherExplainsMore,
  kFurtherExplainLittleMore,
  kAsManyAsAllowed,
  kAsManyAsAskedFor,
  kEarlierRefined,  // the lights of an earlier solve
  kAllStay,         // where they are: their intensities alone were sought
  kTimeLimit,
  kThresholdMet,  // of the lightcut
  kEveryCluster,  // is a light, of the published method
  kNoneReaches,   // no light of the grid reaches the painted surfaces
};

// In words, for people.
const char* words_for(Termination termination);

}  // namespace chiaro::inverse
