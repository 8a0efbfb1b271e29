#include "renderer/image/small_text.h"

namespace chiaro::renderer {
namespace {

constexpr int kLetterWidth = 5, kAdvance = kLetterWidth + 1;

struct Letter {
  char name;
  const char* rows[kTextHeight];
};

constexpr Letter kLetters[] = {
    {'0', {" ### ", "#   #", "#   #", "#   #", "#   #", "#   #", " ### "}},
    {'1', {"  #  ", " ##  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "}},
    {'8', {" ### ", "#   #", "#   #", " ### ", "#   #", "#   #", " ### "}},
    {'.', {"     ", "     ", "     ", "     ", "     ", " ##  ", " ##  "}},
    {'-', {"     ", "     ", "     ", " ### ", "     ", "     ", "     "}},
    {'|', {"  #  ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  "}},
    {'x', {"     ", "     ", "#   #", " # # ", "  #  ", " # # ", "#   #"}},
    {'A', {" ### ", "#   #", "#   #", "#####", "#   #", "#   #", "#   #"}},
    {'B', {"#### ", "#   #", "#   #", "#### ", "#   #", "#   #", "#### "}},
    {'F', {"#####", "#    ", "#    ", "#### ", "#    ", "#    ", "#    "}},
    {'I', {" ### ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "}},
    {'L', {"#    ", "#    ", "#    ", "#    ", "#    ", "#    ", "#####"}},
    {'P', {"#### ", "#   #", "#   #", "#### ", "#    ", "#    ", "#    "}},
};

void fill_white(int left, int top, int size, Image& picture) {
  for (int y = top; y < top + size; ++y) {
    for (int x = left; x < left + size; ++x) {
      if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) continue;
      for (int c = 0; c < picture.channel_count(); ++c) picture.at(x, y)[c] = 1;
    }
  }
}

void draw_letter(const Letter& letter, int left, int top, int scale, Image& picture) {
  for (int y = 0; y < kTextHeight; ++y) {
    for (int x = 0; x < kLetterWidth; ++x) {
      if (letter.rows[y][x] == '#') fill_white(left + x * scale, top + y * scale, scale, picture);
    }
  }
}

}  // namespace

int text_width(std::string_view text, int scale) { return int(text.size()) * kAdvance * scale; }

void draw_text(std::string_view text, int left, int top, int scale, Image& picture) {
  for (const char name : text) {
    for (const Letter& letter : kLetters) {
      if (letter.name == name) draw_letter(letter, left, top, scale, picture);
    }
    left += kAdvance * scale;
  }
}

}  // namespace chiaro::renderer
