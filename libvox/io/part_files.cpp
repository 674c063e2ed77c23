// Which part files belong together, and their metadata.

#include "libvox/io/part_files.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/merge_report.h"
#include "libvox/options/option_text.h"
#include "libvox/options/run_part.h"

#include <openvdb/io/GridDescriptor.h>

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

namespace vox {
namespace {

constexpr const char* kLevelsMetadata = "vox_levels";
constexpr const char* kVoxelsMetadata = "vox_active_voxels";

std::string textOf(const openvdb::MetaMap& metadata, const char* key) {
  const auto value = metadata[key];
  return value ? value->str() : std::string();
}

std::optional<int> numberIn(const openvdb::GridBase& grid, const char* key) {
  const auto value = grid.getMetadata<openvdb::Int32Metadata>(key);
  return value ? std::optional(value->value()) : std::nullopt;
}

/// What must be the same in all parts: a name for messages, and its content.
using Trait = std::pair<std::string, std::string>;

std::string transformText(const openvdb::GridBase& grid) {
  std::ostringstream bytes;
  grid.writeTransform(bytes);
  return bytes.str();
}

std::vector<Trait> traitsOf(const VdbIndex& file) {
  std::string names;
  std::string types;
  std::string transforms;
  std::string compressions;
  for (const VdbIndexGrid& grid : file.grids) {
    names += grid.descriptor->uniqueName() + '\n';
    types += grid.descriptor->gridType() + (grid.descriptor->saveFloatAsHalf() ? " half\n" : "\n");
    transforms += transformText(*grid.head);
    compressions += std::to_string(grid.compression) + '\n';
  }
  const openvdb::GridBase& first = *file.grids.front().head;
  return {{"another version of vox", textOf(first, "vox_version")},
          {"another input", textOf(first, "vox_input") + '\n' + textOf(first, "vox_input_hash")},
          {"other options", textOf(first, kOptionsMetadata)},
          {"other grids", names},
          {"other types of grids", types},
          {"another transform", transforms},
          {"another compression", compressions},
          {"another version of OpenVDB", std::to_string(file.format)}};
}

/// Checks that all files have the traits that most of them have.
void requireSameTraits(const std::vector<VdbIndex>& files) {
  std::vector<std::vector<Trait>> traits;
  std::map<std::vector<Trait>, std::size_t> counts;
  for (const VdbIndex& file : files) ++counts[traits.emplace_back(traitsOf(file))];
  const auto most =
      std::max_element(traits.begin(), traits.end(),
                       [&](const auto& a, const auto& b) { return counts.at(a) < counts.at(b); });
  const std::string usual = files[static_cast<std::size_t>(most - traits.begin())].file.string();
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto differs =
        std::mismatch(traits[i].begin(), traits[i].end(), most->begin(), most->end()).first;
    if (differs != traits[i].end())
      throw InputError(files[i].file.string() + ": is of another conversion than " + usual +
                       ": it has " + differs->first);
  }
}

void requireSameNumbers(const VdbIndex& file) {
  for (const VdbIndexGrid& grid : file.grids)
    for (const char* key : {kRunPartMetadata, kRunPartsMetadata})
      if (textOf(*grid.head, key) != textOf(*file.grids.front().head, key))
        throw InputError(file.file.string() + ": its grids are not of one part");
}

std::string partOf(int number, int count) {
  return "part " + std::to_string(number) + " of " + std::to_string(count);
}

/// Statistics that OpenVDB adds when it writes a grid.
bool isStatistic(const std::string& key) {
  return key.starts_with("file_");
}

bool isOfPart(const std::string& key) {
  return key == kRunPartMetadata || key == kRunPartsMetadata;
}

/// Adds one value to the metadata of the whole.
/// @return  false if the whole has another value
bool addMetadata(const std::string& key, const openvdb::Metadata& value, openvdb::MetaMap& whole) {
  using Count = openvdb::Int64Metadata;
  using Level = openvdb::Int32Metadata;
  const auto before = whole[key];
  if (!before)
    whole.insertMeta(key, value);
  else if (key == kVoxelsMetadata && value.typeName() == Count::staticTypeName())
    static_cast<Count&>(*before).value() += static_cast<const Count&>(value).value();
  else if (key == kLevelsMetadata && value.typeName() == Level::staticTypeName())
    static_cast<Level&>(*before).value() = std::max(static_cast<const Level&>(*before).value(),
                                                    static_cast<const Level&>(value).value());
  else
    return *before == value;
  return true;
}

}  // namespace

bool isPartFile(const VdbIndex& file) {
  return !file.grids.empty() &&
         std::all_of(file.grids.begin(), file.grids.end(), [](const VdbIndexGrid& grid) {
           return numberIn(*grid.head, kRunPartMetadata) && numberIn(*grid.head, kRunPartsMetadata);
         });
}

PartFiles orderedParts(std::vector<VdbIndex> files) {
  requireSameTraits(files);
  PartFiles set;
  for (const VdbIndex& file : files) {
    requireSameNumbers(file);
    const int number = *numberIn(*file.grids.front().head, kRunPartMetadata);
    const int count = *numberIn(*file.grids.front().head, kRunPartsMetadata);
    if (number < 1 || number > count || count > kMostRunParts)
      throw InputError(file.file.string() + ": is " + partOf(number, count) + ", which cannot be");
    set.count = std::max(set.count, count);
  }
  std::map<int, VdbIndex*> bySlot;  // a slot is as wide as the smallest parts
  for (VdbIndex& file : files) {
    const int number = *numberIn(*file.grids.front().head, kRunPartMetadata);
    const int count = *numberIn(*file.grids.front().head, kRunPartsMetadata);
    const std::string text = partOf(number, count);
    const int width = set.count / count;
    if (set.count % count != 0 || !std::has_single_bit(static_cast<unsigned>(width)))
      throw InputError(file.file.string() + ": is " + text + ", which does not fit to parts of " +
                       std::to_string(set.count));
    for (int slot = (number - 1) * width + 1; slot <= number * width; ++slot) {
      const auto [other, isNew] = bySlot.emplace(slot, &file);
      if (!isNew)
        throw InputError(file.file.string() + ": is " + text + ", which is in " +
                         other->second->file.string() + ", too");
    }
  }
  const VdbIndex* last = nullptr;
  for (int slot = 1; slot <= set.count; ++slot) {
    const auto part = bySlot.find(slot);
    if (part == bySlot.end()) {
      set.missing.push_back(slot);
    } else if (part->second != last) {
      last = part->second;
      set.parts.push_back(std::move(*part->second));
    }
  }
  return set;
}

std::string partsText(const std::vector<int>& numbers) {
  std::string text = numbers.size() == 1 ? "part" : "parts";
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    text += (i == 0 ? " " : ", ") + std::to_string(numbers[i]);
    if (end - i > 1) text += '-' + std::to_string(numbers[end - 1]);
    i = end;
  }
  return text;
}

openvdb::MetaMap metadataOfWhole(std::span<const VdbIndex> files,
                                 std::span<const openvdb::MetaMap* const> metadata) {
  openvdb::MetaMap whole;
  for (std::size_t i = 0; i < files.size(); ++i)
    for (auto item = metadata[i]->beginMeta(); item != metadata[i]->endMeta(); ++item)
      if (!isStatistic(item->first) && !isOfPart(item->first) &&
          !addMetadata(item->first, *item->second, whole))
        throw InputError(files[i].file.string() + ": has another value of the metadata " +
                         item->first + " than the parts before it");
  return whole;
}

}  // namespace vox
