# Writes OUTPUT, a source that defines lowlap::kPageSource with the files HTML,
# STYLE, SCRIPT and THREE (lists, joined) as raw string literals.
function(read_files variable)
  set(all "")
  foreach(file IN LISTS ARGN)
    file(READ "${file}" text)
    if(text MATCHES "\\)lowlap_page\"")
      message(FATAL_ERROR "${file} holds )lowlap_page\", which ends the literal")
    endif()
    string(APPEND all "${text}\n")
  endforeach()
  set(${variable} "R\"lowlap_page(${all})lowlap_page\"" PARENT_SCOPE)
endfunction()

read_files(html ${HTML})
read_files(style ${STYLE})
read_files(script ${SCRIPT})
read_files(three ${THREE})
if(NOT THREE)
  set(three "\"\"")
endif()
file(WRITE "${OUTPUT}"
"#include \"lowlap/report/internal/page_source.h\"

namespace lowlap {

const PageSource kPageSource = {
    ${html},
    ${style},
    ${script},
    ${three}};

}  // namespace lowlap
")
