# embed_files(TARGET NAMESPACE HEADER FILE…): makes the bytes of files a part of a library, where
# NAMESPACE::embedded_file("name without folder"), declared in HEADER, finds them.
function(embed_files target namespace header)
  set(assembly "  .section .rodata\n")
  set(declarations "")
  set(rows "")
  set(number 0)
  foreach(file ${ARGN})
    get_filename_component(path ${file} ABSOLUTE)
    get_filename_component(name ${file} NAME)
    set(symbol chiaro_${target}_file_${number})
    string(APPEND assembly "  .global ${symbol}, ${symbol}_end\n${symbol}:\n  .incbin \"${path}\"\n${symbol}_end:\n")
    string(APPEND declarations "extern \"C\" const char ${symbol}[], ${symbol}_end[];\n")
    string(APPEND rows "  if (name == \"${name}\") return {${symbol}, std::size_t(${symbol}_end - ${symbol})};\n")
    math(EXPR number "${number} + 1")
    list(APPEND paths ${path})
  endforeach()
  string(APPEND assembly "  .section .note.GNU-stack,\"\",%progbits\n")
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/embedded)
  file(CONFIGURE OUTPUT ${folder}/${target}.S CONTENT "${assembly}" @ONLY)
  file(CONFIGURE OUTPUT ${folder}/${target}.cpp @ONLY CONTENT
"#include \"${header}\"

${declarations}
namespace ${namespace} {

std::string_view embedded_file(std::string_view name) {
${rows}  return {};
}

}  // namespace ${namespace}
")
  set_source_files_properties(${folder}/${target}.S PROPERTIES OBJECT_DEPENDS "${paths}")
  target_sources(${target} PRIVATE ${folder}/${target}.S ${folder}/${target}.cpp)
endfunction()
