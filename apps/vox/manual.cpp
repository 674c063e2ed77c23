// Manual page and shell completion from the option table.

#include "apps/vox/manual.h"

#include "libvox/core/version.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <sstream>
#include <vector>

namespace vox::app {
namespace {

/// As text that roff takes for nothing else.
std::string roff(const std::string& text) {
  std::string escaped;
  bool atStart = true;
  for (const char c : text) {
    if (atStart && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\')
      escaped += "\\e";
    else if (c == '-')
      escaped += "\\-";
    else
      escaped += c;
    atStart = c == '\n';
  }
  return escaped;
}

/// Options of a command that help shows, groups in their order.
std::vector<const CLI::Option*> shownOptions(const CLI::App& command) {
  std::vector<const CLI::Option*> shown;
  for (const std::string& group : command.get_groups())
    for (const CLI::Option* option : command.get_options())
      if (!group.empty() && option->get_group() == group && option->nonpositional())
        shown.push_back(option);
  return shown;
}

bool takesValue(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

void addOptions(std::ostream& page, const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      page << ".TP\n.I " << roff(option->get_name(true)) << '\n'
           << roff(option->get_description()) << '\n';
  for (const CLI::Option* option : shownOptions(command)) {
    std::string names = option->get_name(false, true);
    std::replace(names.begin(), names.end(), ',', ' ');
    page << ".TP\n\\fB" << roff(names) << "\\fR";
    if (takesValue(*option)) page << " \\fI" << roff(option->get_type_name()) << "\\fR";
    page << '\n' << roff(option->get_description()) << '\n';
  }
}

/// "6|26" and "voxel|levels=K" as words; nothing of "FILE".
std::string wordsOf(const std::string& typeName) {
  if (typeName.find('|') == std::string::npos) return {};
  std::string words;
  std::istringstream list(typeName);
  for (std::string word; std::getline(list, word, '|');) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) word.resize(equals + 1);
    words += (words.empty() ? "" : " ") + word;
  }
  return words;
}

std::string longNames(const CLI::App& command) {
  std::string names;
  for (const CLI::Option* option : shownOptions(command))
    for (const std::string& name : option->get_lnames())
      names += (names.empty() ? "--" : " --") + name;
  return names;
}

}  // namespace

std::string manualPage(const CLI::App& app) {
  std::ostringstream page;
  page << ".TH VOX 1 \"\" \"vox " << version() << "\"\n.SH NAME\n"
       << "vox \\- smooth voxel models in OpenVDB from irregular polygon meshes\n.SH SYNOPSIS\n"
       << ".B vox\n.I COMMAND\n[\\fIOPTIONS\\fR] ...\n.SH DESCRIPTION\n"
       << roff(app.get_description()) << "\n.SH COMMANDS\n";
  for (const CLI::App* command : app.get_subcommands({})) {
    page << ".SS vox " << roff(command->get_name()) << '\n'
         << roff(command->get_description()) << '\n';
    addOptions(page, *command);
    if (!command->get_footer().empty())
      page << ".PP\n.nf\n" << roff(command->get_footer()) << "\n.fi\n";
  }
  page << ".SH EXIT STATUS\n" << roff(app.get_footer()) << '\n';
  return page.str();
}

std::string bashCompletion(const CLI::App& app) {
  std::ostringstream values;
  std::ostringstream options;
  std::string commands;
  for (const CLI::App* command : app.get_subcommands({})) {
    const std::string name = command->get_name();
    commands += (commands.empty() ? "" : " ") + name;
    options << "    " << name << ") options='" << longNames(*command) << "' ;;\n";
    for (const CLI::Option* option : shownOptions(*command)) {
      const std::string words = wordsOf(option->get_type_name());
      if (words.empty() || option->get_lnames().empty()) continue;
      values << "    " << name << ":--" << option->get_lnames().front() << ") values='" << words
             << "' ;;\n";
    }
  }
  return "# bash completion of vox " + std::string(version()) +
         "\n_vox() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "  local command=${COMP_WORDS[1]} values= options=\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W '" +
         commands +
         " --help --version' -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  case $command:$previous in\n" +
         values.str() +
         "  esac\n"
         "  case $command in\n" +
         options.str() +
         "  esac\n"
         "  if [ -n \"$values\" ]; then\n"
         "    COMPREPLY=($(compgen -W \"$values\" -- \"$current\"))\n"
         "  elif [[ $current == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$current\"))\n"
         "  fi  # else files, by default\n"
         "}\n"
         "complete -o default -F _vox vox\n";
}

}  // namespace vox::app
