#include "inverse/solve/termination.h"

namespace chiaro::inverse {

const char* words_for(Termination termination) {
  switch (termination) {
    case Termination::kNoFurtherExplainsMore:
      return "no further light explains more";
    case Termination::kFurtherExplainLittleMore:
      return "further lights explain little more";
    case Termination::kAsManyAsAllowed:
      return "as many lights as allowed";
    case Termination::kAsManyAsAskedFor:
      return "as many lights as asked for";
    case Termination::kEarlierRefined:
      return "the earlier lights are refined";
    case Termination::kAllStay:
      return "all lights stay where they are";
    case Termination::kTimeLimit:
      return "time limit";
    case Termination::kThresholdMet:
      return "error threshold of the lightcut met";
    case Termination::kEveryCluster:
      return "every cluster is a light";
    case Termination::kNoneReaches:
      break;
  }
  return "no light of the grid reaches the painted surfaces";
}

}  // namespace chiaro::inverse
