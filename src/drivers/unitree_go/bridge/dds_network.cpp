#include "drivers/unitree_go/bridge/dds_network.h"

#include <arpa/inet.h>
#include <dds/dds.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

#include "drivers/unitree_go/go_messages.h"
#include "rt/realtime_thread.h"
#include "unitree_go.h"

namespace robot_control::unitree::go {
namespace {

using CommandSample = unitree_go_msg_dds__LowCmd_;
using StateSample = unitree_go_msg_dds__LowState_;
using RequestSample = unitree_api_msg_dds__Request_;
using ResponseSample = unitree_api_msg_dds__Response_;
static_assert(sizeof(CommandSample) == kCommandBytes && sizeof(StateSample) == kStateBytes);

constexpr std::int32_t kAnswersPerCall = 8;

dds_entity_t checked(dds_entity_t entity, const char* what, const std::string& interface) {
  if (entity > 0) return entity;
  throw DdsError(std::string("CycloneDDS cannot make ") + what + " on the interface " + interface + ": " +
                 dds_strretcode(-entity) +
                 "; set the key interface of the drive file to one that `ip link` lists as up");
}

/// A name of an interface has no character that XML reserves. The loopback does not announce that it has multicast.
/// After the lease the writer of a bridge that was killed does not count as another one.
std::string configuration(const std::string& interface) {
  return "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"" + interface + "\"" +
         (interface == "lo" ? " multicast=\"true\"" : "") +
         "/></Interfaces></General><Discovery><LeaseDuration>1s</LeaseDuration></Discovery></Domain></CycloneDDS>";
}

/// CycloneDDS 0.10 receives at all addresses of the computer, whatever its interface is. With this its sockets take
/// what comes over the loopback alone.
void keep_to_loopback() {
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const std::string name = entry.path().filename().string();
    int number = -1;
    std::from_chars(name.data(), name.data() + name.size(), number);
    sockaddr_in address{};
    socklen_t size = sizeof address;
    auto* const generic = static_cast<sockaddr*>(static_cast<void*>(&address));
    if (getsockname(number, generic, &size) != 0 || address.sin_family != AF_INET) continue;
    if (ntohl(address.sin_addr.s_addr) != INADDR_ANY) continue;
    if (setsockopt(number, SOL_SOCKET, SO_BINDTODEVICE, "lo", 3) == 0) continue;
    throw DdsError(std::string("a socket of CycloneDDS cannot be kept to the loopback: ") + std::strerror(errno) +
                   "; use Linux 5.7 or a later one");
  }
}

struct QosDeleter {
  void operator()(dds_qos_t* qos) const noexcept { dds_delete_qos(qos); }
};

}  // namespace

struct DdsNetwork::Impl {
  Receiver on_message;
  std::string interface;
  bool takes_states = false;
  dds_entity_t domain = 0, participant = 0, writer = 0, reader = 0;
  dds_entity_t others = 0, requests = 0, responses = 0;

  ~Impl() {
    if (domain > 0) dds_delete(domain);
  }

  dds_entity_t topic(const dds_topic_descriptor_t& type, const char* name) const {
    return checked(dds_create_topic(participant, &type, name, nullptr, nullptr), name, interface);
  }

  template <class Sample>
  static void receive(dds_entity_t reader, void* self) {
    static thread_local const bool precedes = precede_ordinary_threads();
    (void)precedes;
    Sample sample{};
    void* place = &sample;
    dds_sample_info_t info;
    while (dds_take(reader, &place, &info, 1, 1) > 0) {
      if (!info.valid_data) continue;
      std::array<std::uint8_t, sizeof(Sample)> bytes;
      std::memcpy(bytes.data(), &sample, sizeof sample);
      if constexpr (std::is_same_v<Sample, StateSample>) {
        clear_gaps_of_state(bytes);
      } else {
        clear_gaps_of_command(bytes);
      }
      static_cast<Impl*>(self)->on_message(bytes, info.publication_handle);
    }
  }
};

DdsNetwork::DdsNetwork(DdsSide side, const std::string& interface, std::uint32_t domain, Receiver on_message)
    : impl_(std::make_unique<Impl>()) {
  Impl& own = *impl_;
  own.on_message = std::move(on_message);
  own.interface = interface;
  own.takes_states = side == DdsSide::kController;
  own.domain = checked(dds_create_domain(domain, configuration(interface).c_str()), "a domain", interface);
  own.participant = checked(dds_create_participant(domain, nullptr, nullptr), "a participant", interface);
  if (interface == "lo") keep_to_loopback();
  const dds_entity_t commands = own.topic(unitree_go_msg_dds__LowCmd__desc, "rt/lowcmd");
  const dds_entity_t states = own.topic(unitree_go_msg_dds__LowState__desc, "rt/lowstate");
  const std::unique_ptr<dds_qos_t, QosDeleter> qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE,
                       0);  // a reader that does not confirm never blocks the writer
  own.writer = checked(dds_create_writer(own.participant, own.takes_states ? commands : states, qos.get(), nullptr),
                       "a writer", interface);
  if (own.takes_states) {
    const std::unique_ptr<dds_qos_t, QosDeleter> of_others(dds_create_qos());
    dds_qset_ignorelocal(of_others.get(), DDS_IGNORELOCAL_PARTICIPANT);
    own.others = checked(dds_create_reader(own.participant, commands, of_others.get(), nullptr), "a reader", interface);
    const dds_entity_t request = own.topic(unitree_api_msg_dds__Request__desc, "rt/api/motion_switcher/request");
    const dds_entity_t response = own.topic(unitree_api_msg_dds__Response__desc, "rt/api/motion_switcher/response");
    own.requests = checked(dds_create_writer(own.participant, request, qos.get(), nullptr), "a writer", interface);
    own.responses = checked(dds_create_reader(own.participant, response, qos.get(), nullptr), "a reader", interface);
  }
  dds_listener_t* listener = dds_create_listener(&own);
  dds_lset_data_available(listener, own.takes_states ? &Impl::receive<StateSample> : &Impl::receive<CommandSample>);
  own.reader = dds_create_reader(own.participant, own.takes_states ? states : commands, nullptr, listener);
  dds_delete_listener(listener);
  checked(own.reader, "a reader", interface);
}

DdsNetwork::~DdsNetwork() = default;

bool DdsNetwork::send(std::span<const std::uint8_t> bytes) noexcept {
  union {
    CommandSample command;
    StateSample state;
  } sample;
  const std::size_t size = impl_->takes_states ? kCommandBytes : kStateBytes;
  if (bytes.size() != size) return false;
  std::memcpy(&sample, bytes.data(), size);
  return dds_write(impl_->writer, &sample) == DDS_RETCODE_OK;
}

std::size_t DdsNetwork::other_writers() const noexcept {
  const dds_return_t count = dds_get_matched_publications(impl_->others, nullptr, 0);
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

bool DdsNetwork::others_sent() noexcept {
  CommandSample sample{};
  void* place = &sample;
  dds_sample_info_t info;
  bool sent = false;
  while (dds_take(impl_->others, &place, &info, 1, 1) > 0) sent = sent || info.valid_data;
  return sent;
}

void DdsNetwork::request(std::int64_t id, std::int64_t api) noexcept {
  std::array<char, 3> parameter{'{', '}', '\0'};
  RequestSample sample{};
  sample.header.identity = {.id = id, .api_id = api};
  sample.parameter = parameter.data();
  dds_write(impl_->requests, &sample);
}

void DdsNetwork::take_answers(
    const std::function<void(std::int64_t id, std::int64_t api, std::int32_t code, std::string_view data)>& take) {
  for (std::int32_t i = 0; i < kAnswersPerCall; ++i) {
    void* place = nullptr;
    dds_sample_info_t info;
    if (dds_take(impl_->responses, &place, &info, 1, 1) <= 0) return;
    const auto& sample = *static_cast<const ResponseSample*>(place);
    if (info.valid_data) {
      const auto& [identity, status] = sample.header;
      take(identity.id, identity.api_id, status.code, sample.data == nullptr ? "" : sample.data);
    }
    dds_return_loan(impl_->responses, &place, 1);
  }
}

}  // namespace robot_control::unitree::go
