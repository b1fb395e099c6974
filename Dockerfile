# The Patchmill service. Build: docker build -t patchmill .
# Run with TLS:  docker run -p 50051:50051 -v DIR:/tls:ro patchmill --cert /tls/server.pem --key /tls/server.key   (docs/operations.md)
FROM debian:bookworm-slim AS build
WORKDIR /src
COPY scripts/setup.sh scripts/setup.sh
RUN scripts/setup.sh build
COPY . .
RUN cmake --preset release -DPATCHMILL_TESTS=OFF -DPATCHMILL_BENCH=OFF \
 && cmake --build --preset release --target patchmill patchmilld \
 && strip build/release/bin/patchmill build/release/bin/patchmilld

FROM debian:bookworm-slim
RUN apt-get update -qq \
 && apt-get install -y -qq --no-install-recommends libgrpc++1.51 libprotobuf32 libabsl20220623 libtbb12 libfmt9 libspdlog1.10 libprometheus-cpp-pull1.0 libopenmesh1 \
 && rm -rf /var/lib/apt/lists/* \
 && useradd --system --uid 10001 --no-create-home patchmill
COPY --from=build /src/build/release/bin/patchmill /src/build/release/bin/patchmilld /usr/local/bin/
COPY LICENSE THIRD_PARTY.md /usr/share/doc/patchmill/
USER patchmill
EXPOSE 50051
HEALTHCHECK --interval=10s --timeout=3s --start-period=5s CMD ["patchmilld", "--check-health", "localhost:50051"]
# Inside a container the service must listen beyond loopback. How it is protected there is for who runs it to say: without
# --cert and --key, or a flag that says that the network is trusted, it exits with status 2 and names both.
ENTRYPOINT ["patchmilld", "--listen", "0.0.0.0:50051"]
