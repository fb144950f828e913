// Messages to and from the command: requests are matched to answers by number, events are unsolicited.
export interface Problem {
  problem: string;
  where: string;
  remedy: string;
}

export class RequestError extends Error {
  constructor(readonly about: Problem) {
    super(about.problem);
  }
}

export interface Answer {
  // eslint-disable-next-line @typescript-eslint/no-explicit-any -- its members depend on the request
  result: any;
  /** Binary data to which `result` refers by [first byte, number of bytes]. */
  bytes: Uint8Array;
}

interface Waiting {
  done: (answer: Answer) => void;
  failed: (error: Error) => void;
}

const nothing = new Uint8Array(0);

/** The secret that authenticates the page to the command; it is only part of the page's address. */
const token = new URLSearchParams(location.search).get("token") ?? "";

export class Link {
  private socket: WebSocket | undefined;
  private number = 0;
  private readonly waiting = new Map<number, Waiting>();
  // eslint-disable-next-line @typescript-eslint/no-explicit-any -- its members depend on the kind of event
  onEvent: (event: any) => void = () => {};
  onState: (open: boolean) => void = () => {};

  /** Opens the connection, and reopens it when it breaks. */
  connect() {
    const address = new URL("messages", location.href);
    address.protocol = "ws:";
    address.search = new URLSearchParams({ token }).toString();
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => this.onState(true);
    socket.onmessage = (message) => this.take(message.data);
    socket.onclose = () => {
      for (const one of this.waiting.values()) one.failed(new RequestError({ problem: "the connection is lost", where: "", remedy: "" }));
      this.waiting.clear();
      this.onState(false);
      setTimeout(() => this.connect(), 1000);
    };
  }

  private take(data: string | ArrayBuffer) {
    let bytes = nothing;
    let text: string;
    if (typeof data === "string") text = data;
    else {
      const size = new DataView(data).getUint32(0, true);
      text = new TextDecoder().decode(new Uint8Array(data, 4, size));
      bytes = new Uint8Array(data, 4 + size);
    }
    const message = JSON.parse(text);
    if (message.event) return this.onEvent(message);
    const one = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.ok) one?.done({ result: message.result, bytes });
    else one?.failed(new RequestError(message.error));
  }

  ask(what: string, more: object = {}): Promise<Answer> {
    return new Promise((done, failed) => {
      if (this.socket?.readyState !== WebSocket.OPEN)
        return failed(new RequestError({ problem: "there is no connection", where: "", remedy: "" }));
      const id = ++this.number;
      this.waiting.set(id, { done, failed });
      this.socket.send(JSON.stringify({ ...more, do: what, id }));
    });
  }

  /** Where an announced file is sent. */
  uploadAddress(batch: string, file: number): URL {
    const address = new URL("upload", location.href);
    address.search = new URLSearchParams({ token, batch, file: String(file) }).toString();
    return address;
  }

  /** Cancels the request in progress. */
  cancel() {
    this.socket?.send('{"do":"cancel"}');
  }
}

export const numbersIn = (answer: Answer, place: [number, number]) =>
  new Float32Array(answer.bytes.buffer, answer.bytes.byteOffset + place[0], place[1] / 4);
export const indicesIn = (answer: Answer, place: [number, number]) =>
  new Uint32Array(answer.bytes.buffer, answer.bytes.byteOffset + place[0], place[1] / 4);
