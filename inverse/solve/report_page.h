#pragma once
// The report's page: one file of HTML that needs nothing else, and asks no network for anything.

#include <string>
#include <string_view>

namespace chiaro::inverse {

// report_page/page.html with the other embedded files at their names in {{ }}, and `data`, JSON without a "<", at
// {{data}}.
std::string make_report_page(std::string_view data);

}  // namespace chiaro::inverse
