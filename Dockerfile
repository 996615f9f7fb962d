# A simulated robot with its console, on any computer with a container engine; docs/install.md explains it.
#   docker build -t robot_control .
#   docker run --rm --init -p 127.0.0.1:8080:8080 robot_control [quadbot] [--scene NAME]
# tests/repository/test_image.py follows these instructions in a clean root, without a container engine.
FROM debian:12 AS build
WORKDIR /robot_control
COPY . .
RUN scripts/setup && bash -c 'source scripts/shell/environment.sh && build_workspace without_tests'
# Packages of the second stage: the owners of the linked libraries, and what the list names beside tools of the build,
# but SciPy and matplotlib, whose packages bring a compiler, 0.5 GB.
RUN find install -type f -exec ldd {} + 2>/dev/null | sed -n 's/.* => .*\/\(lib[^ ]*\) (.*/*\/\1/p' | sort -u \
      | xargs dpkg -S | cut -d: -f1 >packages \
 && awk 'BEGIN { wanted = 1 } /^\[/ { wanted = $1 == "[console]" } \
      wanted && /^(python3|ros|libjs)/ && !/-dev|colcon|pytest|rostest|venv|scipy|matplotlib/ { print $1 }' \
      scripts/shell/dependencies.txt >>packages

FROM debian:12
COPY --from=build /robot_control/packages /robot_control/packages
RUN apt-get update \
 && xargs apt-get install -y --no-install-recommends </robot_control/packages \
 && apt-get clean && rm -rf /var/lib/apt/lists/* \
 && useradd --create-home robot \
 && echo 'source /robot_control/install/setup.bash' >>/etc/bash.bashrc
COPY --from=build /robot_control/install /robot_control/install
COPY --from=build /robot_control/build/xacro /robot_control/build/xacro
USER robot
WORKDIR /home/robot
# The port of the console is published on the loopback of the host alone: docs/install.md.
ENV ROBOT_CONTROL_PUBLISHED_ON_LOOPBACK=1 PYTHONUNBUFFERED=1 LANG=C.UTF-8
EXPOSE 8080
ENTRYPOINT ["/bin/bash", "-c", "source /robot_control/install/setup.bash && exec python3 -m robot_control.watch.trial --port 8080 --no-browser \"$@\"", "robot_control"]
