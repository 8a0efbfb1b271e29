#pragma once

#include <filesystem>
#include <optional>

namespace chiaro::cli {

double memory_bytes();  // of this machine, or what its control groups allow: those of containers and job schedulers

// What control groups allow, of which `/proc/self/cgroup` lists this process's and `/sys/fs/cgroup` holds all; infinity
// where they do not limit it. Source: Linux, Documentation/admin-guide/cgroup-v2.rst and cgroup-v1/memory.rst.
double control_group_limit(const std::filesystem::path& list, const std::filesystem::path& groups);

// What may still be taken up of `limit` bytes; absent: of three quarters of memory_bytes().
double memory_left(std::optional<double> limit);

// From here on what would make much more of this process than `bytes` cannot be allocated, so that it ends by saying so:
// the kernel would end it, or another, without a word. Much more: a quarter and a gigabyte, as what is mapped counts, and
// stacks of threads hardly are used. Nothing where less is allowed already, and where more is mapped, as by sanitizers.
void limit_memory(double bytes);

double swap_bytes();  // what of memory may be kept on disks

}  // namespace chiaro::cli
