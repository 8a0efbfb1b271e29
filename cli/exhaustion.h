#pragma once
// Where memory or threads run out.

namespace chiaro::cli {

// Of the exception that is being handled: what ran out; null where it is of something else.
const char* what_ran_out();

// From here on what nobody catches of that, as in the initialisers of libraries, ends the program with one line and
// kFailed, and so does, at once, less memory than libraries start with. Needs nothing that is initialised.
void prepare_for_exhaustion();

}  // namespace chiaro::cli
