// Input files as strings, with a message for each reason why a file cannot be read.

#include "libvox/io/input_file.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"

#include <fstream>
#include <system_error>

namespace vox {

namespace fs = std::filesystem;

void requireInputFile(const fs::path& file) {
  const std::string name = file.string();
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    throw InputError(name + ": no such file; check the path");
  if (error) throw InputError(name + ": cannot be read: " + error.message());
  if (fs::is_directory(status)) throw InputError(name + ": is a directory; name a file inside it");
  if (!fs::is_regular_file(status))
    throw InputError(name + ": is not a regular file; copy its content to a file first");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw InputError(name + ": cannot be read: " + error.message());
  if (size == 0) throw InputError(name + ": the file is empty");
}

std::string contentsOf(const fs::path& file) {
  requireInputFile(file);
  const std::string name = file.string();
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(name + ": cannot be opened; check its permissions");

  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (!error && size > availableMemory())
    throw LimitError(name + ": " + formatBytes(size) + " do not fit into memory");
  std::string contents(error ? 0 : size, '\0');
  in.read(contents.data(), static_cast<std::streamsize>(contents.size()));
  if (error || in.bad() || static_cast<std::uintmax_t>(in.gcount()) != size)
    throw InputError(name + ": could be read only in part");
  return contents;
}

std::string lowerExtension(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');  // the same in every locale
  return extension;
}

}  // namespace vox
