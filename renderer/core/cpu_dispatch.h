#pragma once

// Before a function: compiled for wider vector units too, one of which is chosen at run time. Where all are to give the
// same bits, its file is compiled without contraction (CMakeLists.txt). Sanitizers cannot instrument the resolvers.
#if defined(__x86_64__) && !defined(CHIARO_SANITIZED)
#define CHIARO_DISPATCH __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CHIARO_DISPATCH
#endif
