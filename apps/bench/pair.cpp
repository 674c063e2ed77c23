// Measures whole processes: two commands in turn; built-in comparisons of vox with other programs;
// and the growth of the cost of vox with its output.

#include "apps/bench/compare.h"
#include "apps/bench/contest_report.h"
#include "apps/bench/report.h"
#include "apps/bench/scaling.h"
#include "apps/bench/suite.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <thread>
#include <unistd.h>
#include <wordexp.h>

namespace vox::bench {
namespace {

const std::vector<int> kDims = {256, 512, 1024};

struct Options {
  std::string commandA;
  std::string commandB;
  std::string suite;
  std::string only;
  UserInput input;
  std::string scaling;
  std::vector<std::string> contest;
  std::string plots;
  std::vector<int> dims;  ///< empty: kDims
  int threads = std::max(2, static_cast<int>(std::thread::hardware_concurrency()));
  int runs = 5;
  Limits limits{.timeoutSeconds = 600};
  std::string json;
  std::string vox;
  bool quiet = false;
};

/// A temporary folder; removed by the destructor.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "vox-bench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Words of a command as the shell would split them: quotes, ~ and variables, but no pipes.
std::vector<std::string> wordsOf(const std::string& command) {
  wordexp_t expansion{};
  if (::wordexp(command.c_str(), &expansion, WRDE_NOCMD) != 0)
    throw CLI::ValidationError(command, "is no command of plain words; quote what is special");
  std::vector<std::string> words(expansion.we_wordv, expansion.we_wordv + expansion.we_wordc);
  ::wordfree(&expansion);
  if (words.empty()) throw CLI::ValidationError("command", "must not be empty");
  return words;
}

void declareSuites(CLI::App& app, Options& options) {
  CLI::App* group = app.add_option_group("Built-in comparisons");
  CLI::Option* suite =
      group
          ->add_option("--suite", options.suite,
                       "issue: vox against loading OpenVDB, CGAL and a naive program; "
                       "hard: vox on meshes that invite a blow-up, against a torus; "
                       "scan: vox on scans of 1, 4 and 10 million triangles, against vdb_tool")
          ->check(CLI::IsMember(suiteNames()));
  group->add_option("--only", options.only, "Only comparisons whose name contains this")
      ->needs(suite)
      ->type_name("TEXT");
  group->add_option("--input", options.input.file, "With issue: a mesh of yours to compare on, too")
      ->needs(suite)
      ->type_name("FILE");
  group->add_option("--input-dim", options.input.dim, "Its resolution")
      ->needs(suite)
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
}

void declareContest(CLI::App& app, Options& options) {
  CLI::App* group = app.add_option_group("Contest");
  CLI::Option* contest =
      group
          ->add_option("--compare", options.contest,
                       "vox against what people would use instead, as Markdown: mesh files or "
                       "generated meshes, with commas")
          ->delimiter(',')
          ->type_name("INPUT,...");
  group->add_option("--plots", options.plots, "Draw time and memory against dim (SVG) there, too")
      ->needs(contest)
      ->check(CLI::ExistingDirectory)
      ->type_name("FOLDER");
}

void declareScaling(CLI::App& app, Options& options) {
  CLI::App* group = app.add_option_group("Scaling");
  CLI::Option* scaling =
      group
          ->add_option("--scaling", options.scaling,
                       "Growth of time and memory with the output: a mesh file or a generated mesh")
          ->type_name("INPUT");
  group
      ->add_option("--dims", options.dims,
                   "Resolutions, with commas; of a contest, too (default: 256,512,1024)")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  group->add_option("--threads", options.threads, "Threads to compare with one")
      ->needs(scaling)
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
}

void declareRun(CLI::App& app, Options& options) {
  CLI::App* group = app.add_option_group("Run");
  group->add_option("--runs", options.runs, "Pairs of runs: A B A B ...")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  group->add_option("--timeout", options.limits.timeoutSeconds, "Seconds until a run is killed")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  group
      ->add_option("--max-memory", options.limits.memoryBytes,
                   "Address space of a run, such as 512M or 16G (default: no limit)")
      ->transform(CLI::AsSizeValue(false))
      ->type_name("SIZE");
  group->add_option("--json", options.json, "Write the numbers to a file, too")->type_name("FILE");
  group->add_option("--vox", options.vox, "The vox to measure (default: the one built along)")
      ->type_name("FILE");
  group->add_flag("-q,--quiet", options.quiet, "Do not say on stderr what runs");
}

void declare(CLI::App& app, Options& options) {
  app.add_option("A", options.commandA, "First command, one word to the shell: 'vox info a.obj'");
  app.add_option("B", options.commandB, "Second command; ratios are B / A");
  declareSuites(app, options);
  declareContest(app, options);
  declareScaling(app, options);
  declareRun(app, options);
}

/// Checks that exactly one task is given.
/// @throws CLI::ValidationError  none or several are given
void requireOneTask(const Options& options) {
  const bool commands = !options.commandA.empty();
  if (commands + !options.suite.empty() + !options.scaling.empty() + !options.contest.empty() != 1)
    throw CLI::ValidationError("give two commands, or --suite, --compare or --scaling");
  if (commands && options.commandB.empty())
    throw CLI::ValidationError("give a second command to compare with");
  if (!options.dims.empty() && options.scaling.empty() && options.contest.empty())
    throw CLI::ValidationError("--dims goes with --compare and --scaling");
}

void write(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(file + ": cannot be written");
}

class Run {
 public:
  explicit Run(const Options& options)
      : options_(options),
        tools_(toolsBeside(std::filesystem::read_symlink("/proc/self/exe"))),
        progress_([quiet = options.quiet](const std::string& text) {
          if (!quiet) std::cerr << text << std::endl;
        }) {
    if (!options.vox.empty()) tools_.vox = options.vox;
  }

  /// Runs all tasks. Prints the result of each as soon as it is there.
  nlohmann::ordered_json measureAll() {
    nlohmann::ordered_json json{{"machine", machineJson()}, {"pairs", options_.runs}};
    if (!options_.scaling.empty()) {
      const Scaling scaling =
          measureScaling(tools_, options_.scaling, options_.dims, options_.threads, options_.runs,
                         options_.limits, folder_.path(), progress_);
      std::cout << tableOf(scaling) << std::flush;
      json["scaling"] = jsonOf(scaling);
      return json;
    }
    if (!options_.contest.empty()) {
      json["contests"] = nlohmann::ordered_json::array();
      for (const std::string& input : options_.contest) json["contests"].push_back(hold(input));
      return json;
    }
    json["comparisons"] = nlohmann::ordered_json::array();
    for (const Case& one : cases()) {
      if (one.name.find(options_.only) == std::string::npos) continue;
      const Comparison comparison =
          compare(one.name, one.a, one.b, options_.runs, options_.limits, progress_);
      std::cout << tableOf(comparison) << std::endl;
      json["comparisons"].push_back(jsonOf(comparison));
    }
    return json;
  }

 private:
  nlohmann::ordered_json hold(const std::string& input) const {
    const Contest contest = holdContest(tools_, input, options_.dims, options_.runs,
                                        options_.limits, folder_.path(), progress_);
    std::cout << markdownOf(contest) << std::flush;
    if (!options_.plots.empty()) {
      const std::string stem = (options_.plots / std::filesystem::path(input).stem()).string();
      write(stem + "_time.svg", svgOf(timePlot(contest)));
      write(stem + "_memory.svg", svgOf(memoryPlot(contest)));
    }
    return jsonOf(contest);
  }

  std::vector<Case> cases() const {
    if (!options_.suite.empty())
      return suiteCases(options_.suite, tools_, options_.input, folder_.path());
    const auto program = [](const std::string& command) {
      const std::vector<std::string> words = wordsOf(command);
      return Program{std::filesystem::path(words.front()).filename().string(), words};
    };
    const Program a = program(options_.commandA);
    const Program b = program(options_.commandB);
    return {{a.name + " against " + b.name, a, b}};
  }

  const Options& options_;
  Tools tools_;
  Progress progress_;
  TemporaryFolder folder_;
};

int run(int argc, char** argv) {
  constexpr int kUsage = 2;
  Options options;
  CLI::App app(
      "Measures whole processes: wall time, CPU time (user + system) and peak memory of two\n"
      "commands in turn, and their ratios B / A, run by run.",
      "vox_bench_pair");
  app.get_formatter()->column_width(34);
  app.footer(
      "A program that is absent, fails, or goes over a limit is reported as such; the exit code "
      "is\n"
      "then 0 all the same. 2 usage, 1 something else is in the way, 130 interrupted.");
  declare(app, options);
  try {
    app.parse(argc, argv);
    requireOneTask(options);
    if (options.dims.empty()) options.dims = kDims;
    const nlohmann::ordered_json json = Run(options).measureAll();
    if (options.json.empty()) return 0;
    write(options.json, json.dump(2) + "\n");
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
}

}  // namespace
}  // namespace vox::bench

int main(int argc, char** argv) {
  constexpr int kFailed = 1;
  constexpr int kInterrupted = 130;
  try {
    return vox::bench::run(argc, argv);
  } catch (const vox::bench::Interrupted&) {
    return kInterrupted;
  } catch (const std::exception& error) {
    std::cerr << "vox_bench_pair: error: " << error.what() << '\n';
    return kFailed;
  }
}
