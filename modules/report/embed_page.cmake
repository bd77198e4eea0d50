# Joins the parts of the page to one HTML file and writes it as C++:
#   cmake -D PAGE=page.html -D STYLE=style.css -D LIBRARY=a.js|b.js -D SCRIPTS=c.js|d.js -D OUTPUT=x.cpp
#         -P embed_page.cmake
# In the page a line `taut:style`, `taut:library` or `taut:script` stands where the part belongs, and
# `taut:title` and `taut:data` where the run's title and its data go.
cmake_minimum_required(VERSION 3.25)

# The text of files, separated by |.
function(join_files files result)
  string(REPLACE "|" ";" files "${files}")
  set(all "")
  foreach(path ${files})
    file(READ "${path}" text)
    string(FIND "${text}" "</script" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${path} would end the script it is put in")
    endif()
    string(APPEND all "${text}\n")
  endforeach()
  set(${result} "${all}" PARENT_SCOPE)
endfunction()

# Puts a text in the place of a marker.
function(put marker text)
  string(FIND "${page}" "${marker}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "${PAGE} has no ${marker}")
  endif()
  string(LENGTH "${marker}" length)
  math(EXPR after "${at} + ${length}")
  string(SUBSTRING "${page}" 0 ${at} before)
  string(SUBSTRING "${page}" ${after} -1 rest)
  set(page "${before}${text}${rest}" PARENT_SCOPE)
endfunction()

# Raw literals of a size that every compiler takes.
function(write_literals)
  string(FIND "${page}" ")taut\"" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "the page holds the end of a raw literal")
  endif()
  string(LENGTH "${page}" size)
  set(literals "")
  set(at 0)
  while(at LESS size)
    string(SUBSTRING "${page}" ${at} 16000 chunk)
    string(APPEND literals "R\"taut(${chunk})taut\",\n")
    math(EXPR at "${at} + 16000")
  endwhile()
  file(WRITE "${OUTPUT}" "// Made by embed_page.cmake.\n#include \"Page.h\"\n\nnamespace taut\n{\n"
       "const std::vector<std::string_view>& pageParts()\n{\n"
       "static const std::vector<std::string_view> parts{\n${literals}};\nreturn parts;\n}\n}\n")
endfunction()

file(READ "${PAGE}" page)
file(READ "${STYLE}" style)
join_files("${LIBRARY}" library)
join_files("${SCRIPTS}" scripts)
put("/* taut:style */" "${style}")
put("/* taut:library */" "${library}")
put("/* taut:script */" "${scripts}")
write_literals()
