/** Collects what three and the browser complain about while a test runs. */
export class ConsoleWatch {
  private readonly messages: string[] = []
  private readonly allowed: RegExp[] = []
  private readonly original = { error: console.error, warn: console.warn }

  constructor() {
    console.error = (...parts: unknown[]) => this.add('error', parts)
    console.warn = (...parts: unknown[]) => this.add('warning', parts)
    addEventListener('unhandledrejection', this.onRejection)
  }

  allow(pattern: RegExp): void {
    this.allowed.push(pattern)
  }

  /** Restores the console; answers with the complaints that no pattern allows, each once. */
  stop(): string[] {
    Object.assign(console, this.original)
    removeEventListener('unhandledrejection', this.onRejection)
    return [...new Set(this.messages)].filter(
      message => !this.allowed.some(pattern => pattern.test(message))
    )
  }

  private add(kind: string, parts: unknown[]): void {
    this.messages.push(`console ${kind}: ${parts.map(String).join(' ')}`)
  }

  private readonly onRejection = (event: PromiseRejectionEvent): void => {
    this.messages.push(`unhandled rejection: ${String(event.reason)}`)
  }
}
