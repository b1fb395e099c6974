// Hands every call on to patchmilld. Messages are not looked into: each is read as a message without fields, whose unknown
// fields keep their bytes. So nothing is lost of a newer contract, and an upload costs no more than its size.
import type { DescMethod, DescService } from "@bufbuild/protobuf";
import { EmptySchema } from "@bufbuild/protobuf/wkt";
import { type ConnectRouter, createClient, type HandlerContext, type ServiceImpl, type Transport } from "@connectrpc/connect";
import { AnalysisService } from "../gen/patchmill/v1/analysis_service_pb.js";
import { ModelService } from "../gen/patchmill/v1/model_service_pb.js";
import { ToolpathService } from "../gen/patchmill/v1/toolpath_service_pb.js";
import { clearError } from "./errors";

export const services: readonly DescService[] = [ToolpathService, AnalysisService, ModelService];

function opaque(service: DescService): DescService {
  const methods = service.methods.map((m) => ({ ...m, input: EmptySchema, output: EmptySchema }) as DescMethod);
  return { ...service, methods, method: Object.fromEntries(methods.map((m) => [m.localName, m])) } as DescService;
}

type Call = (request: never, options: object) => unknown;

// Authorization is the only header that patchmilld, or a proxy before it, has to see.
function optionsOf(context: HandlerContext): object {
  const token = context.requestHeader.get("authorization");
  const timeoutMs = context.timeoutMs();
  return {
    signal: context.signal,
    headers: token === null ? {} : { authorization: token },
    ...(timeoutMs === undefined ? {} : { timeoutMs }),
  };
}

export function forward(router: ConnectRouter, transport: Transport, backend: string): void {
  for (const service of services.map(opaque)) {
    const client = createClient(service, transport) as unknown as Record<string, Call>;
    const routes: Record<string, unknown> = {};
    for (const method of service.methods) {
      const call = client[method.localName]!;
      if (method.methodKind === "unary") {
        routes[method.localName] = async (request: never, context: HandlerContext) => {
          try {
            return await (call(request, optionsOf(context)) as Promise<object>);
          } catch (error) {
            throw clearError(error, backend);
          }
        };
      } else if (method.methodKind === "server_streaming") {
        routes[method.localName] = async function* (request: never, context: HandlerContext) {
          try {
            yield* call(request, optionsOf(context)) as AsyncIterable<object>;
          } catch (error) {
            throw clearError(error, backend);
          }
        };
      }
      // A browser cannot send a stream of requests. Such a method is not there (HTTP 404 or 415).
    }
    router.service(service, routes as Partial<ServiceImpl<DescService>>);
  }
}
