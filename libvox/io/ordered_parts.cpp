// Parts made on all threads and written in order, by whichever thread finishes the next one.

#include "libvox/io/ordered_parts.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <ostream>
#include <vector>

namespace vox {
namespace {

/// The parts that are being made or wait for their turn to be written.
class Queue {
 public:
  Queue(std::ostream& stream, std::size_t length) : stream_(stream), slots_(length) {}

  /// Makes and writes: the next part, and then parts that others have made. Parts are begun in
  /// order, so the part whose turn it is is always in work, and nobody waits for it in vain.
  template <class Make>
  void advance(const Make& make) {
    std::unique_lock lock(mutex_);
    written_.wait(lock, [&] { return failed_ || begun_ < turn_ + slots_.size(); });
    if (failed_) return;
    const std::size_t part = begun_++;
    Slot& slot = slotOf(part);
    try {
      lock.unlock();
      slot.bytes.clear();
      make(part, slot.bytes);
      lock.lock();
      slot.ready = true;
      if (!writing_) writeReady(lock);
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      failed_ = true;
      written_.notify_all();
      throw;
    }
  }

 private:
  struct Slot {
    PartBytes bytes;
    bool ready = false;
  };

  Slot& slotOf(std::size_t part) { return slots_[part % slots_.size()]; }

  void writeReady(std::unique_lock<std::mutex>& lock) {
    writing_ = true;
    while (!failed_ && slotOf(turn_).ready) {
      Slot& slot = slotOf(turn_);
      lock.unlock();
      const auto bytes = slot.bytes.bytes();
      stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      lock.lock();
      slot.ready = false;
      ++turn_;
      written_.notify_one();
    }
    writing_ = false;
  }

  std::ostream& stream_;
  std::vector<Slot> slots_;
  std::mutex mutex_;  // guards all members but the stream, the writer's, and bytes, their maker's
  std::condition_variable written_;
  std::size_t begun_ = 0;  // parts
  std::size_t turn_ = 0;   // part to be written next
  bool writing_ = false;
  bool failed_ = false;
};

}  // namespace

char* PartBytes::extend(std::size_t count) {
  if (capacity_ - size_ < count) {
    const std::size_t capacity = std::max(2 * capacity_, size_ + count);
    auto larger = std::make_unique_for_overwrite<char[]>(capacity);
    if (size_ > 0) std::memcpy(larger.get(), bytes_.get(), size_);
    bytes_ = std::move(larger);
    capacity_ = capacity;
  }
  char* const end = bytes_.get() + size_;
  size_ += count;
  return end;
}

std::streamsize PartBytes::xsputn(const char* bytes, std::streamsize count) {
  if (count > 0)
    std::memcpy(extend(static_cast<std::size_t>(count)), bytes, static_cast<std::size_t>(count));
  return count;
}

PartBytes::int_type PartBytes::overflow(int_type byte) {
  if (!traits_type::eq_int_type(byte, traits_type::eof()))
    *extend(1) = traits_type::to_char_type(byte);
  return traits_type::not_eof(byte);
}

void writeInOrder(std::ostream& stream, std::size_t count,
                  const std::function<void(std::size_t, PartBytes&)>& make) {
  constexpr int kMostParts = 64;
  const int parts = std::min(2 * tbb::this_task_arena::max_concurrency(), kMostParts);
  Queue queue(stream, static_cast<std::size_t>(parts));
  parallelForEach(count, 1, [&](std::size_t) { queue.advance(make); });
}

}  // namespace vox
