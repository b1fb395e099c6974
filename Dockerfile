# The Patchmill service. Build: docker build -t patchmill .
# Run with TLS:  docker run -p 50051:50051 -v DIR:/tls:ro patchmill --cert /tls/server.pem --key /tls/server.key   (docs/operations.md)
#
# BASE: the image that this one begins with; name it with its digest (debian:bookworm-slim@sha256:...), so that the same sources give
#   the same image. It has to be Debian 12.
# PROGRAMS: "build" compiles here; "prebuilt" takes patchmill, patchmilld and patchmill-import from the folder programs/ of the
#   context, as scripts/container_test.sh lays it out. They have to be built on Debian 12, too.
# VERSION, REVISION, CREATED: for the labels. BASE_DIGEST: the digest of BASE, for its label.
ARG BASE=debian:bookworm-slim
ARG PROGRAMS=build

FROM ${BASE} AS build
WORKDIR /src
COPY scripts/setup.sh scripts/setup.sh
RUN scripts/setup.sh cad
COPY . .
RUN cmake --preset release -DPATCHMILL_TESTS=OFF -DPATCHMILL_BENCH=OFF -DPATCHMILL_CAD=ON \
 && cmake --build --preset release --target patchmill patchmilld \
 && mkdir /programs && cp build/release/bin/patchmill build/release/bin/patchmilld build/release/bin/patchmill-import /programs/

FROM ${BASE} AS prebuilt
COPY programs/ /programs/

FROM ${PROGRAMS} AS programs

# Open CASCADE's readers of STEP and IGES. Debian's package of them also has what draws, and so it depends on X11. The libraries of
# the readers alone, unchanged, are packed again without these two dependencies.
FROM ${BASE} AS readers
RUN apt-get update -qq && mkdir /readers && cd /readers \
 && apt-get download -qq libocct-data-exchange-7.6 && dpkg-deb -R *.deb package && rm *.deb \
 && sed -i -E '/^Depends:/s/, libocct-(ocaf|visualization)-7[.]6 [(][^)]*[)]//g' package/DEBIAN/control \
 && find package/usr/lib -name 'lib*.so*' ! -name 'libTKSTEP*' ! -name 'libTKIGES*' ! -name 'libTKXSBase*' -delete \
 && rm package/DEBIAN/md5sums && dpkg-deb -b package readers.deb

FROM ${BASE} AS runtime
COPY --from=readers /readers/readers.deb /tmp/
RUN apt-get update -qq \
 && apt-get install -y -qq --no-install-recommends libgrpc++1.51 libprotobuf32 libabsl20220623 libtbb12 libfmt9 libspdlog1.10 libprometheus-cpp-pull1.0 libopenmesh1 \
      libseccomp2 libocct-modeling-algorithms-7.6 libocct-modeling-data-7.6 libocct-foundation-7.6 \
 && dpkg -i /tmp/readers.deb && rm /tmp/readers.deb \
 && rm -rf /var/lib/apt/lists/* /var/cache/apt/* /var/log/* /var/cache/ldconfig/* \
 && useradd --uid 10001 --no-create-home --shell /usr/sbin/nologin patchmill

# What the image consists of. The package database is copied before the tools that write the document are installed.
FROM runtime AS described
RUN cp -r /var/lib/dpkg /image \
 && apt-get update -qq \
 && apt-get install -y -qq --no-install-recommends python3 binutils libeigen3-dev libstb-dev libcli11-dev fonts-dejavu-core
COPY --from=programs /programs/ /programs/
COPY CMakeLists.txt /src/
COPY scripts/sbom.py /src/scripts/
RUN strip /programs/patchmill /programs/patchmilld /programs/patchmill-import \
 && python3 /src/scripts/sbom.py --image /image -o /sbom.spdx.json /programs/patchmill /programs/patchmilld /programs/patchmill-import

FROM runtime
ARG BASE
ARG BASE_DIGEST=""
ARG VERSION=""
ARG REVISION=""
ARG CREATED=""
LABEL org.opencontainers.image.title="Patchmill" \
      org.opencontainers.image.description="Verified tool paths for free-form surfaces, as a service" \
      org.opencontainers.image.licenses="Apache-2.0" \
      org.opencontainers.image.version="${VERSION}" \
      org.opencontainers.image.revision="${REVISION}" \
      org.opencontainers.image.created="${CREATED}" \
      org.opencontainers.image.base.name="${BASE}" \
      org.opencontainers.image.base.digest="${BASE_DIGEST}"
COPY --from=described /programs/patchmill /programs/patchmilld /programs/patchmill-import /usr/local/bin/
COPY --from=described /sbom.spdx.json /usr/share/doc/patchmill/
COPY LICENSE THIRD_PARTY.md /usr/share/doc/patchmill/
USER 10001:10001
EXPOSE 50051
HEALTHCHECK --interval=10s --timeout=3s --start-period=5s CMD ["patchmilld", "--check-health", "localhost:50051"]
# Inside a container the service must listen beyond loopback. How it is protected there is for who runs it to say: without
# --cert and --key, or a flag that says that the network is trusted, it exits with status 2 and names both.
ENTRYPOINT ["patchmilld", "--listen", "0.0.0.0:50051"]
