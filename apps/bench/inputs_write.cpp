// Writes a generated mesh to a file, for programs that measure whole processes.

#include "apps/bench/inputs.h"
#include "libvox/core/error.h"
#include "libvox/io/write_mesh.h"

#include <CLI/CLI.hpp>

#include <fstream>
#include <iostream>
#include <string>

int main(int argc, char** argv) {
  std::string names = "Meshes:\n";
  for (const auto& input : vox::bench::inputs())
    names += "  " + std::string(input.name) + ": " + std::string(input.what) + "\n";
  CLI::App app("Writes a generated mesh to a file.", "vox_bench_inputs_write");
  app.footer(names);
  std::string name;
  std::string file;
  app.add_option("NAME", name, "Mesh to generate")->required();
  app.add_option("FILE", file, "Where to: .obj, .ply or .off")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    std::ofstream out(file, std::ios::binary);
    vox::writeMesh(out, vox::bench::makeInput(name), vox::meshFormatFor(file));
    out.close();
    if (!out) throw vox::IoError(file + ": cannot be written");
    return 0;
  } catch (const vox::Error& error) {
    std::cerr << "vox_bench_inputs_write: error: " << error.what() << '\n';
    return error.exitCode();
  }
}
