#include "inverse/solve/report_page.h"

#include "inverse/solve/embedded_file.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {

std::string make_report_page(std::string_view data) {
  const std::string_view text = embedded_file("page.html");
  std::string page;
  std::size_t end = 0;
  for (std::size_t begin = text.find("{{"); begin != text.npos; begin = text.find("{{", end)) {
    page.append(text.substr(end, begin - end));
    end = text.find("}}", begin) + 2;
    const std::string_view name = text.substr(begin + 2, end - begin - 4);
    const std::string_view part = name == "data" ? data : embedded_file(name);
    CHIARO_CHECK(!part.empty());
    page.append(part);
  }
  return page.append(text.substr(end));
}

}  // namespace chiaro::inverse
