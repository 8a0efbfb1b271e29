#pragma once

#include <string>
#include <string_view>

namespace chiaro::cli {

// As text or as the value of a quoted attribute. Control characters, which HTML cannot hold, become U+FFFD.
std::string html_escaped(std::string_view text);

// `data:image/png;base64,…`
std::string png_data_uri(std::string_view png);

// Every "{{name}}" of `page` becomes what `part(name)` gives.
template <class Part>
std::string fill_in(std::string_view page, const Part& part) {
  std::string filled;
  std::size_t end = 0;
  for (std::size_t begin = page.find("{{"); begin != page.npos; begin = page.find("{{", end)) {
    filled.append(page.substr(end, begin - end));
    end = page.find("}}", begin) + 2;
    filled.append(part(page.substr(begin + 2, end - begin - 4)));
  }
  return filled.append(page.substr(end));
}

}  // namespace chiaro::cli
