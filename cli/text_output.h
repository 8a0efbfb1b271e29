#pragma once
// What people read.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::cli {

using TextRow = std::pair<std::string, std::string>;

// "  name   value" lines, the values aligned.
std::string aligned_rows(const std::vector<TextRow>& rows);

// Lines of cells; the first row is the heading; columns aligned to the right but the first.
std::string table(std::vector<std::vector<std::string>> rows);

double degrees_of(double radians);
std::string text_of_vector(renderer::Vec3f v);                // "1.25 0 -3"
std::string text_of_seconds(double seconds);                  // "0.31 s", "4 min 05 s"
std::string text_of_percent(std::optional<double> fraction);  // "4.12 %", "not known"
std::string text_of_bytes(double bytes);                      // "1.2 GB"
std::string text_of_interval(renderer::Vec3f half);           // the widest of three half widths: "0.012", "not known"

// The same in one line, as terminals and programs can take it, whatever names of files are in it: line ends and what
// else terminals obey (terminal_text.h) become spaces, bytes that are no UTF-8 the replacement character.
std::string one_line(const std::string& text);

// All that goes to standard output goes through here, line ends alone as they are. Error when it does not take it.
void print(const std::string& text);

// All that goes to standard error, but for the progress bar: "chiaro: " and the text, in one line.
void print_message(const std::string& text);

}  // namespace chiaro::cli
