#pragma once

#include <string>

namespace chiaro::cli {

// What an option of the form NAME=FILE says.
struct NamedFile {
  std::string name, file;  // name empty: none was given
};

// Names and files may both have an "=" in them: it is split where a file of that name is, the text as a whole being one
// first of all, and at the first "=" where none is.
NamedFile split_named_file(const std::string& text);

}  // namespace chiaro::cli
