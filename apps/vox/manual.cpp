// Manual page, option tables in Markdown and shell completion, all from the option table.

#include "apps/vox/manual.h"

#include "apps/vox/option_help.h"
#include "libvox/core/version.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>
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

std::vector<const CLI::Option*> positionals(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

/// Text below the options of a command; empty if it only inherits the program's.
std::string ownFooter(const CLI::App& command, const CLI::App& app) {
  return command.get_footer() == app.get_footer() ? std::string() : command.get_footer();
}

void addOptions(std::ostream& page, const CLI::App& command) {
  for (const CLI::Option* option : positionals(command))
    page << ".TP\n.I " << roff(option->get_name(true)) << '\n'
         << roff(option->get_description()) << '\n';
  for (const CLI::Option* option : shownOptions(command)) {
    std::string names = option->get_name(false, true);
    std::replace(names.begin(), names.end(), ',', ' ');
    page << ".TP\n\\fB" << roff(names) << "\\fR";
    if (const std::string value = valueName(*option); !value.empty())
      page << " \\fI" << roff(value) << "\\fR";
    page << '\n' << roff(description(*option)) << '\n';
  }
}

/// As text of a cell in a Markdown table.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.insert(at, 1, '\\');
  return text;
}

/// "`-o, --output`"; with `suffix`, "`-o, --output OUT.vdb`".
std::string code(const CLI::Option& option, const std::string& suffix = {}) {
  std::string names = option.get_name(option.get_positional(), true);
  if (const std::size_t comma = names.find(','); comma != std::string::npos)
    names.insert(comma + 1, 1, ' ');
  return '`' + names + (suffix.empty() ? "" : ' ' + suffix) + '`';
}

/// Row of an option in a table, the same for the same option of two commands.
std::string row(const CLI::Option& option) {
  const std::string value = option.get_positional() ? std::string() : valueName(option);
  return "| " + cell(code(option, value)) + " | " + cell(description(option)) + " |\n";
}

/// For each row of a table the command that it was printed for first.
using FirstCommand = std::map<std::string, std::string>;

void addTable(std::ostream& page, const CLI::App& command, FirstCommand& firstCommand) {
  page << "| argument or option | meaning |\n|---|---|\n";
  for (const CLI::Option* option : positionals(command)) page << row(*option);
  std::map<std::string, std::string> shared;  // by command: options described there
  std::string group;
  for (const CLI::Option* option : shownOptions(command)) {
    if (option == command.get_help_ptr()) continue;
    const auto& [text, first] = *firstCommand.try_emplace(row(*option), command.get_name()).first;
    if (first != command.get_name()) {
      shared[first] += (shared[first].empty() ? "" : ", ") + code(*option);
      continue;
    }
    if (option->get_group() != group) page << "| **" << option->get_group() << "** | |\n";
    group = option->get_group();
    page << text;
  }
  for (const auto& [first, names] : shared)
    page << "\nThe same as for [vox " << first << "](#vox-" << first << "): " << names << ".\n";
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
    if (const std::string footer = ownFooter(*command, app); !footer.empty())
      page << ".PP\n.nf\n" << roff(footer) << "\n.fi\n";
  }
  page << ".SH EXIT STATUS\n" << roff(app.get_footer()) << '\n';
  return page.str();
}

std::string markdownTables(const CLI::App& app) {
  std::ostringstream page;
  FirstCommand firstCommand;
  for (const CLI::App* command : app.get_subcommands({})) {
    page << "<!-- options of vox " << command->get_name() << " -->\n\n"
         << command->get_description() << ".\n\n```\nvox " << command->get_name() << " [OPTIONS]";
    for (const CLI::Option* option : positionals(*command))
      page << ' ' << option->get_name(true) << (option->get_items_expected_max() > 1 ? "..." : "");
    page << "\n```\n\n";
    addTable(page, *command, firstCommand);
    if (const std::string footer = ownFooter(*command, app); !footer.empty())
      page << "\n```\n" << footer << (footer.ends_with('\n') ? "" : "\n") << "```\n";
    page << "\n<!-- end of options -->\n";
  }
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
