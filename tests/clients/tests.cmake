patchmill_test(clients/render DEPS clients/render)
