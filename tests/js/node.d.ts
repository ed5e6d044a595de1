/** As much of node as the tests use; its own types would have to be downloaded. */

interface TestContext {
  mock: { timers: { enable(how: { apis: string[] }): void; tick(ms: number): void } };
}

declare module "node:test" {
  export function test(name: string, run: (context: TestContext) => void | Promise<void>): void;
  export default test;
  export const mock: {
    fn(): { (...args: unknown[]): void; mock: { callCount(): number } };
  };
}

declare module "node:assert/strict" {
  interface Assert {
    equal(found: unknown, expected: unknown, message?: string): void;
    notEqual(found: unknown, expected: unknown): void;
    deepEqual(found: unknown, expected: unknown, message?: string): void;
    notDeepEqual(found: unknown, expected: unknown): void;
    match(text: string, pattern: RegExp, message?: string): void;
    ok(found: unknown, message?: string): asserts found;
  }
  const assert: Assert;
  export default assert;
}

declare module "node:fs" {
  export function readFileSync(file: string, encoding: "utf-8"): string;
  export function readdirSync(folder: string, how: { recursive: true; encoding: "utf-8" }): string[];
}

declare module "node:path" {
  const path: {
    sep: string;
    dirname(file: string): string;
    join(...parts: string[]): string;
    resolve(...parts: string[]): string;
    relative(from: string, to: string): string;
  };
  export default path;
}

declare module "node:readline" {
  export function createInterface(how: { input: unknown }): AsyncIterable<string>;
}

declare var process: { stdin: unknown; stdout: { write(text: string): void }; argv: string[] };

interface ImportMeta {
  dirname: string;
}
