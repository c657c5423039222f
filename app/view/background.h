// A thread that does the newest of the jobs it is given, after everything else that wants a processor, and tells what it has
// found so far.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace arealab {

// Lets other threads go first, by so many steps of niceness; threads that this one starts inherit it.
void Yield(int steps);

template <typename Job, typename Found>
class Background {
 public:
  // Does a job in the thread; looks at Overtaken() now and then. Throws nothing.
  using Work = std::function<void(const Job&, Background&)>;

  // `make` is called in the thread, at the first job; `wake`, from there too, where there is news.
  Background(std::function<Work()> make, std::function<void()> wake)
      : make_(std::move(make)), wake_(std::move(wake)), thread_([this] { Run(); }) {}
  ~Background() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
      changed_.notify_all();
    }
    thread_.join();
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  void Submit(Job job) {
    const std::lock_guard lock(mutex_);
    next_ = std::move(job);
    news_.reset();
    ++newest_;
    busy_ = true;
    changed_.notify_all();
  }
  // The last that was found for the newest job, where it is more than at the last call.
  std::optional<Found> News() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, std::nullopt);
  }
  bool busy() const { return busy_; }

  bool Overtaken() const { return stop_ || newest_ != running_; }
  void Publish(Found found) {
    {
      const std::lock_guard lock(mutex_);
      if (newest_ != running_) return;
      news_ = std::move(found);
    }
    wake_();
  }

 private:
  void Run() {
    Yield(10);
    Work work;
    while (true) {
      Job job;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return stop_ || next_.has_value(); });
        if (stop_) return;
        job = std::move(*next_);
        next_.reset();
        running_ = newest_.load();
      }
      if (!work) work = make_();
      work(job, *this);
      {
        const std::lock_guard lock(mutex_);
        busy_ = next_.has_value();
      }
      wake_();
    }
  }

  std::function<Work()> make_;
  std::function<void()> wake_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Job> next_;
  std::optional<Found> news_;
  std::atomic<bool> stop_{false}, busy_{false};
  std::atomic<std::uint64_t> newest_{0}, running_{0};
  std::thread thread_;
};

}  // namespace arealab
