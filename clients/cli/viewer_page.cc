#include "clients/cli/viewer_page.h"

#ifdef PATCHMILL_VIEWER_PAGE
// The assembler reads the file: as a string literal, it would cost the compiler a minute.
asm(".section .rodata\n"
    "patchmill_viewer_page_begin:\n"
    ".incbin \"" PATCHMILL_VIEWER_PAGE
    "\"\n"
    "patchmill_viewer_page_end:\n"
    ".previous\n");
extern const char page_begin[] asm("patchmill_viewer_page_begin");
extern const char page_end[] asm("patchmill_viewer_page_end");
#endif

namespace patchmill::cli {

std::string_view ViewerPage() {
#ifdef PATCHMILL_VIEWER_PAGE
  return {page_begin, static_cast<std::size_t>(page_end - page_begin)};
#else
  return {};
#endif
}

}  // namespace patchmill::cli
