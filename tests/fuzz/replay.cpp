// Runs a fuzz target without libFuzzer: first on its corpus, then on mutations of it, which are the
// same in every run. If the target crashes, the file INPUT has the bytes.
// Usage: replay CORPUS COUNT INPUT

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

constexpr unsigned kMostSeconds = 60;  // for one input; more counts as a hang, with any sanitizer

std::vector<std::string> readCorpus(const fs::path& folder) {
  std::vector<fs::path> files(fs::directory_iterator(folder), fs::directory_iterator{});
  std::sort(files.begin(), files.end());
  std::vector<std::string> corpus;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return corpus;
}

std::size_t below(std::size_t end, std::mt19937& random) {
  return random() % std::max<std::size_t>(end, 1);
}

std::string pieceOf(const std::string& text, std::mt19937& random) {
  return text.substr(below(text.size(), random), 1 + below(64, random));
}

/// Pieces of text that often reveal faults: numbers at the limits of their types, and separators.
std::string tellingPiece(std::mt19937& random) {
  constexpr std::string_view kPieces[] = {"0"sv,
                                          "-1"sv,
                                          "4294967295"sv,
                                          "2147483648"sv,
                                          "99999999999999999999"sv,
                                          "1e308"sv,
                                          "nan"sv,
                                          "-inf"sv,
                                          "1e-320"sv,
                                          "\n"sv,
                                          " "sv,
                                          "/"sv,
                                          "\""sv,
                                          "#"sv,
                                          "\\\n"sv,
                                          "[["sv,
                                          "\0\0\0\0"sv,
                                          "\377\377\377\377"sv,
                                          "\r\n"sv,
                                          "\177\0"sv};
  return std::string(kPieces[below(std::size(kPieces), random)]);
}

void change(std::string& text, const std::vector<std::string>& corpus, std::mt19937& random) {
  const std::size_t at = below(text.size() + 1, random);
  switch (random() % 7) {
    case 0:
      if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << random() % 8));
      break;
    case 1:
      if (at < text.size()) text[at] = static_cast<char>(random());
      break;
    case 2:
      text.erase(at, 1 + below(32, random));
      break;
    case 3:
      text.insert(at, pieceOf(text + ' ', random));
      break;
    case 4:
      text.insert(at, pieceOf(corpus[below(corpus.size(), random)] + ' ', random));
      break;
    case 5: {
      const std::string piece = tellingPiece(random);
      text.replace(at, random() % 2 * piece.size(), piece);
      break;
    }
    default:
      text.resize(random() % 4 == 0 ? at : text.size());
  }
}

std::string mutation(const std::vector<std::string>& corpus, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::string text = corpus[below(corpus.size(), random)];
  for (std::size_t changes = 1 + below(8, random); changes > 0; --changes)
    change(text, corpus, random);
  return text;
}

void run(const std::string& text, const fs::path& input) {
  std::ofstream(input, std::ios::binary) << text;
  alarm(kMostSeconds);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  alarm(0);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: " << argv[0] << " CORPUS COUNT INPUT\n";
    return 2;
  }
  const std::vector<std::string> corpus = readCorpus(argv[1]);
  const auto count = static_cast<std::uint32_t>(std::stoul(argv[2]));
  if (corpus.empty()) {
    std::cerr << argv[1] << ": no corpus\n";
    return 1;
  }
  for (const std::string& text : corpus) run(text, argv[3]);
  for (std::uint32_t seed = 0; seed < count; ++seed) run(mutation(corpus, seed), argv[3]);
  fs::remove(argv[3]);
  std::cout << corpus.size() << " files of the corpus, " << count << " mutations\n";
  return 0;
}
